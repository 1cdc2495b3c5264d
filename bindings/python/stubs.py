#!/usr/bin/env python3
"""stubs.py OUT: the types of the extension module freiform._core, as a .pyi file.

Arguments and plain results come from the signatures that pybind11 keeps in docstrings. Where a function answers with
"an object" the type is what the package says of it: the annotation of the method whose body is `return _core.f(..)` or
`return self._c.f(..)`.
"""
import ast
import inspect
import pathlib
import re
import sys


def answers(package):
    """{(handle class or "", name of a function): annotation of what it gives}, and the modules where types live."""
    found, homes = {}, {}
    for path in sorted(package.glob("_*.py")):
        tree = ast.parse(path.read_text())
        for scope in [tree] + [n for n in ast.walk(tree) if isinstance(n, ast.ClassDef)]:
            handle = ""
            if isinstance(scope, ast.ClassDef):
                homes[scope.name] = path.stem
                text = ast.unparse(scope)
                named = re.search(r"_Patch\[_core\.(\w+)\]|_c(?:: | = |, self\._arguments = )_core\.(\w+Handle)", text)
                handle = next((g for g in named.groups() if g), "") if named else ""
            for node in scope.body:
                if not isinstance(node, ast.FunctionDef) or node.returns is None:
                    continue
                annotation = ast.unparse(node.returns)
                if re.search(r"\bP\b", annotation):
                    continue
                for statement in ast.walk(node):
                    value = statement.value if isinstance(statement, ast.Return) else None
                    if isinstance(value, ast.IfExp):
                        value = value.body
                    if isinstance(value, ast.BoolOp):
                        value = value.values[-1]
                    function = value.func if isinstance(value, ast.Call) else value
                    if not isinstance(function, ast.Attribute):
                        continue
                    owner = ast.unparse(function.value)
                    if owner == "_core":
                        found.setdefault(("", function.attr), set()).add(annotation)
                    elif owner == "self._c":
                        found.setdefault((handle, function.attr), set()).add(annotation)
                    elif owner.startswith("_core.") and owner.endswith("Handle"):
                        found.setdefault((owner[6:], function.attr), set()).add(annotation)
    # A name that two places give different types stays open.
    return {name: types.pop() for name, types in found.items() if len(types) == 1}, homes


def python_type(t):
    t = t.replace("numpy.ndarray[numpy.float64]", "Array").replace("numpy.ndarray[numpy.int32]", "Array")
    t = re.sub(r"numpy\.ndarray(\[[\w.]+\])?", "Array", t)
    t = re.sub(r"freiform\._core\.", "", t)
    t = re.sub(r"\b(List|Tuple|Dict)\[", lambda m: m[1].lower() + "[", t)
    t = re.sub(r"(list\[[\w.]+)\[\d+\]\]", r"\1]", t)
    t = re.sub(r"list\[([^\[\]]*(?:\[[^\[\]]*\])?)\]\[\d+\]", r"Sequence[\1]", t)
    t = re.sub(r"(\w+(?:\[[^\[\]]*\])?)\[(\d+)\]", r"Sequence[\1]", t)
    t = re.sub(r"\blist\[", "Sequence[", t)
    t = re.sub(r"Optional\[(.*)\]", r"\1 | None", t)
    t = t.replace("std::basic_string_view<char, std::char_traits<char> >", "str")
    t = re.sub(r"\bobject\b|\bhandle\b", "Any", t) if "::" not in t else "Any"
    t = re.sub(r"\blist\b(?!\[)", "list[Any]", t)
    t = re.sub(r"\btuple\b(?!\[)", "tuple[Any, ...]", t)
    return re.sub(r"\bdict\b(?!\[)", "dict[str, Any]", t)


def parameters(text):
    """Arguments of a signature as in a .pyi; `self` and names that are Python's words are left as they are."""
    parts, depth, last = [], 0, 0
    for i, c in enumerate(text + ","):
        depth += (c in "[(") - (c in "])")
        if c == "," and depth == 0:
            parts.append(text[last:i].strip())
            last = i + 1
    out = []
    for part in filter(None, parts):
        name, _, kind = part.partition(": ")
        out.append("self" if name == "self" else f"{name}: {python_type(kind)}")
    return ", ".join(out)


def functions(name, doc, known, indent, owner="", static=False):
    lines = []
    signatures = re.findall(r"(?:^|\n)(?:\d+\. )?%s\((.*)\) -> (.*)" % re.escape(name), doc or "")
    for arguments, result in signatures:
        # A string argument may be given as bytes where text of a file is meant.
        arguments = re.sub(r"\b(data|bytes): str", r"\1: str | bytes", parameters(arguments))
        result = python_type(result)
        if (owner, name) in known and result in ("Any", "tuple[Any, ...]", "list[Any]", "Array", "bytes"):
            result = known[owner, name]
        if len(signatures) > 1:
            lines.append(indent + "@overload")
        if static:
            lines.append(indent + "@staticmethod")
        lines.append(f"{indent}def {name}({arguments}) -> {result}: ...")
    return lines


def main():
    out = pathlib.Path(sys.argv[1])
    sys.path[0] = str(out.parent.parent)  # not the sources beside this file
    from freiform import _core
    known, homes = answers(out.parent)
    body = []
    for name, value in sorted(vars(_core).items()):
        if inspect.isclass(value):
            body.append(f"class {name}:")
            members = []
            for key, member in sorted(vars(value).items()):
                if isinstance(member, property):
                    result = re.search(r"-> (.*)", member.fget.__doc__ or "")
                    kind = python_type(result[1]) if result else "Any"
                    if (name, key) in known and kind in ("Any", "Array", "tuple[Any, ...]"):
                        kind = known[name, key]
                    members += ["    @property", f"    def {key}(self) -> {kind}: ..."]
                elif key == "__init__" or not key.startswith("_"):
                    static = isinstance(member, staticmethod)
                    members += functions(key, member.__func__.__doc__ if static else member.__doc__, known, "    ", name, static)
            body += members or ["    ..."]
        elif callable(value):
            body += functions(name, value.__doc__, known, "")
        elif name.isidentifier() and not name.startswith("__"):
            body.append(f"{name}: {'Array' if name.startswith('matrix_') else 'bool'}")
    text = "\n".join(body) + "\n"
    needed = {}
    for name in re.findall(r"\b[A-Z]\w+\b", text):
        if name in homes and not name.endswith("Handle"):
            needed.setdefault(homes[name], set()).add(name)
    head = ['"""Generated by stubs.py."""', "from typing import Any, Sequence, overload", "", "from ._base import Array"]
    head += [f"from .{module} import {', '.join(sorted(names))}" for module, names in sorted(needed.items())]
    extra = "Pair = tuple[float, float]\nQuaternion4 = tuple[float, float, float, float]\n"
    text = "\n".join(head) + "\n\n" + extra + "\n" + text
    if not out.exists() or out.read_text() != text:
        out.write_text(text)


if __name__ == "__main__":
    main()
