"""Writes the stub of the compiled module from what pybind11 says of it: python3 make_stub.py FOLDER_OF_MODULE FILE."""

import inspect
import re
import sys

NAMES = [(r"_understory\.", ""), (r"numpy\.(ndarray|dtype)(\[(\w|:|\.)*(\[[^\]]*\])?\])?", r"np.\1"),
         (r"\b(object|handle)\b", "Any"), (r"-> dtype", "-> np.dtype"), (r"\b(Callable|List|Dict|Tuple|Set)\b", lambda found: found[1].lower()),
         (r"= <.*?>", "= ..."), (r"\bcallable\[.*?\]", "Any")]


def translated(text):
    for pattern, name in NAMES:
        text = re.sub(pattern, name, text)
    return text


def signatures(function):
    """Lines "name(arguments) -> type", several of an overloaded function."""
    lines = (function.__doc__ or "").splitlines()
    numbered = [line.split(". ", 1)[1] for line in lines if re.match(r"\d+\. ", line)]
    return [translated(line) for line in numbered or lines[:1] if "->" in line]


def function_lines(function, indent=""):
    found = signatures(function)
    for signature in found:
        if len(found) > 1:
            yield indent + "@overload"
        yield f"{indent}def {signature}: ..."


def class_lines(name, kind):
    base = kind.__mro__[1]
    yield f"\nclass {name}({base.__name__}):" if base in (ValueError, RuntimeError) else f"\nclass {name}:"
    body = [f'    """{kind.__doc__}"""'] if kind.__doc__ and base.__name__ == "pybind11_object" else []
    for member, value in vars(kind).items():
        if isinstance(value, property):
            result = translated(value.fget.__doc__.split("-> ")[1].strip())
            body += [f"    {member}: {result}"] if value.fset else ["    @property", f"    def {member}(self) -> {result}: ..."]
        elif inspect.isroutine(value) and (member == "__init__" or not member.startswith("_")):
            body += [re.sub(r"self: \w+", "self", line) for line in function_lines(value, "    ")]
    yield from body or ["    ..."]


def stub(module):
    yield '"""What the compiled module holds, as it says itself. The package `understory` is its public face."""\n'
    yield "from typing import Any, Optional, Union, overload\n\nimport numpy as np\n\n__version__: str"
    for name, value in vars(module).items():
        if inspect.isclass(value):
            yield from class_lines(name, value)
    yield ""
    for name, value in vars(module).items():
        if inspect.isroutine(value):
            yield from function_lines(value)


if __name__ == "__main__":
    sys.path.insert(0, sys.argv[1])
    import _understory

    text = "\n".join(stub(_understory)) + "\n"
    compile(text, sys.argv[2], "exec")
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(text)
