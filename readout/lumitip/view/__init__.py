"""The live view: fingertips in a browser, served from this computer, nothing fetched from others.

    lumitip view twin://demo

`room` keeps the fingertips, `finger` reads one, `wire` is what travels, `session` serves one
browser, `guard` lets in only whom it should, `app` and `server` put them together. The page is in
`static`: plain JavaScript modules, no build step.
"""
