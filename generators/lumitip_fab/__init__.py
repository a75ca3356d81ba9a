"""Lumitip on the maker's side: one parameter file to every part, and the proof that they fit."""
