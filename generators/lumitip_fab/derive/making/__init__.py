"""How the parts are made: printed, cast, wrapped and bought."""
