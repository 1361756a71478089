"""Each Python example of README.md runs, in a folder with the run that it speaks of."""
import contextlib
import io
import os
import re
import shutil
import unittest

from support import ROOT, SCRATCH, SHORT, simulate, small_case

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class Readme(unittest.TestCase):
    def test_examples_run(self):
        blocks = BLOCK.findall((ROOT / "README.md").read_text())
        self.assertGreaterEqual(len(blocks), 2)
        folder = SCRATCH / "readme"
        folder.mkdir()
        simulate(folder / "out")
        # The case that the examples name, but the small one.
        text = small_case().read_text()
        for key, value in SHORT.items():
            name = key.split(".")[1]
            text = re.sub(rf"^{name} = .*$", f"{name} = '{value}'", text, flags=re.MULTILINE)
        (folder / "my_case.toml").write_text(text)
        shutil.copy(ROOT / "apps" / "python" / "read_run.py", folder)
        before = os.getcwd()
        os.chdir(folder)
        os.environ["XDG_CACHE_HOME"] = str(SCRATCH)  # of settled beds
        try:
            for block in blocks:
                with self.subTest(block), contextlib.redirect_stdout(io.StringIO()) as printed:
                    exec(compile(block, "README.md", "exec"), {"__name__": "__main__"})
                if "print(" in block:
                    self.assertTrue(printed.getvalue())
        finally:
            os.chdir(before)


if __name__ == "__main__":
    unittest.main()
