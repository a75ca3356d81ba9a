"""Who is wired to whom, with currents and loads."""
