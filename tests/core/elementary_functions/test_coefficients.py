"""The coefficients are those that the script computes."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]


def test_coefficients_are_what_the_script_writes():
    script = ROOT / "tools" / "elementary_coefficients.py"
    made = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    header = ROOT / "src" / "elementary_functions" / "coefficients.hpp"
    assert made.stdout == header.read_text(encoding="utf-8")
