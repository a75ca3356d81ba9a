"""Values of parts as drawings and order numbers tell them."""


def resistor_code(ohm: float) -> str:
    """The value as printed on drawings and in order numbers: 150R, 4K99, 75K, 1M."""
    power, letter = next((p, c) for p, c in ((6, "M"), (3, "K"), (0, "R")) if ohm >= 10**p or not p)
    digits = f"{ohm / 10**power:.4g}"
    return digits.replace(".", letter) if "." in digits else digits + letter
