"""Tools that prepare a release: distributions, lock file and bills. Not installed."""
