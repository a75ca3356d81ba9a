"""The subcommands of `lumitip`, one module each."""
