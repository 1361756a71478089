"""_core.pyi and the docstrings: what the compiled module has is what the stubs say, and everything says what it is."""
import ast
import inspect
import unittest

import jamscope
from jamscope import _core, metrics, statistics
from support import ROOT

STUB = ROOT / "apps" / "python" / "jamscope" / "_core.pyi"


def public(names):
    """Without what pybind11 adds by itself."""
    return {n for n in names if not n.startswith("_") or n in ("__len__", "__getitem__", "__iter__", "__next__", "__version__")}


class Stubs(unittest.TestCase):
    def setUp(self):
        self.tree = ast.parse(STUB.read_text())
        self.classes = {node.name: node for node in self.tree.body if isinstance(node, ast.ClassDef)}
        self.functions = {node.name: node for node in self.tree.body if isinstance(node, ast.FunctionDef)}

    def test_they_have_the_names_of_the_module(self):
        values = {node.target.id for node in self.tree.body if isinstance(node, ast.AnnAssign)}
        self.assertEqual(set(self.classes) | set(self.functions) | values, public(vars(_core)))

    def test_classes_have_the_members_of_the_module(self):
        for name, node in self.classes.items():
            members = {m.name for m in node.body if isinstance(m, ast.FunctionDef)} | {m.target.id for m in node.body if isinstance(m, ast.AnnAssign)}
            self.assertEqual(members, public(vars(getattr(_core, name))), name)

    def test_functions_have_the_arguments_of_the_module(self):
        def arguments(node):
            return [a.arg for a in node.args.posonlyargs + node.args.args if a.arg != "self"]

        def of_docstring(doc):
            # The first line of pybind11's docstrings is the signature.
            signature = doc.splitlines()[0]
            inside = signature[signature.index("(") + 1:signature.rindex(") ->")]
            parts, depth, start = [], 0, 0
            for k, c in enumerate(inside):
                depth += c in "[(" 
                depth -= c in "])"
                if c == "," and depth == 0:
                    parts.append(inside[start:k])
                    start = k + 1
            parts.append(inside[start:])
            names = [p.split(":")[0].split("=")[0].strip() for p in parts if p.strip()]
            return [n for n in names if n not in ("self", "arg0")]

        checked = 0
        for name, node in self.functions.items():
            self.assertEqual(arguments(node), of_docstring(getattr(_core, name).__doc__), name)
            checked += 1
        for name, node in self.classes.items():
            for member in node.body:
                if isinstance(member, ast.FunctionDef) and not member.decorator_list and not member.name.startswith("_"):
                    self.assertEqual(arguments(member), of_docstring(getattr(getattr(_core, name), member.name).__doc__), f"{name}.{member.name}")
                    checked += 1
        self.assertGreater(checked, 40)

    def test_everything_says_what_it_is(self):
        for module in (jamscope, metrics, statistics):
            for name in module.__all__:
                if not name.startswith("__") and name != "commit":
                    self.assertTrue(inspect.getdoc(getattr(module, name)), f"{module.__name__}.{name}")
        for name in self.classes:
            cls = getattr(_core, name)
            for member in public(vars(cls)) - {"__len__", "__iter__", "__next__", "units", "none"}:
                self.assertTrue((inspect.getdoc(vars(cls)[member]) or "").strip(), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
