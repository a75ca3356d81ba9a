"""`python -m lumitip_fab`: the command `lumitip-fab`."""

import sys

from lumitip_fab.cli import main

sys.exit(main())
