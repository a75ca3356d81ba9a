"""Choice of automatic values: computed starts, then the smallest changes that every rule passes."""
