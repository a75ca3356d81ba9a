"""Names that users give, in several scripts."""

NAMES = (
    "Gripper left",
    "finger-2 (test)",
    "R&D <v2>",
    "cell_array_7",
    "Überfinger Größe 2",
    "Doigt à crème brûlée",
    "Mała łapka żółta",
    "Αισθητήρας αφής",
    "Тактильный палец",
    "Палець №2",
    "触觉指尖",
    "触覚センサー",
    "촉각 손가락",
    "حساس اللمس",
    "חיישן מגע",
    "स्पर्श संवेदक",
    "Ngón tay cảm biến",
    "Tastçı ıİğş",
)
REVISIONS = ("B", "1", "2.1", "v3", "2026-11", "A-1")
DEVICES = (
    "Finger 1",
    "Lumitip-left",
    "lab 3/robot 2",
    "Größe S",
    "Палец",
    "触覚",
    "손끝",
    "لمس",
    "αφή",
)
"""At most 29 bytes of UTF-8: what one scan response carries."""
