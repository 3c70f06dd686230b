"""What the tests of the Python module share."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
EXAMPLES = SOURCE / "docs" / "examples" / "python"
SHORT = {"forest.length_m": 20}  # a flight of half a second of wall time


def program(*arguments, status=0, env=None):
    """What `understory` prints; fails the test at another status."""
    command = [os.environ["UNDERSTORY_PROGRAM"], *map(str, arguments)]
    ended = subprocess.run(command, capture_output=True, text=True, env=env)
    if ended.returncode != status:
        raise AssertionError(f"{command}: status {ended.returncode}, not {status}: {ended.stderr}")
    return ended.stdout + ended.stderr


def native(*arguments, status=0):
    """The digest of a flight of the program."""
    with tempfile.TemporaryDirectory() as folder:
        row = Path(folder) / "row.json"
        program("fly", *arguments, "--quiet", "--row", row, status=status)
        text = row.read_text()
    return text.split('"digest": "')[1].split('"')[0]


class InFolder(unittest.TestCase):
    """Each test has a folder of its own."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)
