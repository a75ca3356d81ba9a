"""The subcommands of `lumitip`."""
