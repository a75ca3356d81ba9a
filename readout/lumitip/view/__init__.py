"""The live view: fingertips in a browser, served from this computer without other sites.

    lumitip view twin://demo

`registry` keeps the fingertips, `finger` reads one, `session` serves one browser, `app` has the
routes, `server` the web server and access control. The page is in `static`: plain JavaScript
modules, no build step.
"""
