"""3D models of the parts on the boards, one file for each package."""
