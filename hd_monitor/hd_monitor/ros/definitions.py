"""Definitions of message types as recordings carry them, written from the message classes themselves."""

import re
from importlib import import_module
from typing import Any

_WORDS = {"boolean": "bool", "octet": "byte", "float": "float32", "double": "float64"}
_LINE = "=" * 80


def class_of(kind: str) -> Any:
    """Return the class of a message type, given as ``package/Type``."""
    package, _, name = kind.partition("/")
    return getattr(import_module(f"{package}.msg"), name)


def definition_of(kind: str) -> str:
    """Write the fields of a message type, ``package/Type``, and of every type within it.

    Examples
    --------
    >>> print(definition_of("std_msgs/Float64"))
    float64 data
    """
    texts: dict[str, str] = {}
    wanted = [kind]
    while wanted:
        name = wanted.pop(0)
        if name not in texts:
            fields = class_of(name).get_fields_and_field_types()
            texts[name] = "\n".join(f"{_type(of)} {field}" for field, of in fields.items())
            wanted += [part for of in fields.values() for part in re.findall(r"\w+/\w+", of)]
    first, *others = texts
    return f"\n{_LINE}\n".join([texts[first], *(f"MSG: {name}\n{texts[name]}" for name in others)])


def _type(of: str) -> str:
    """Write a field's type as message files do: ``sequence<double>`` is ``float64[]``."""
    if sequence := re.fullmatch(r"sequence<([^,>]+)(?:, (\d+))?>", of):
        return f"{_type(sequence[1])}[{f'<={sequence[2]}' if sequence[2] else ''}]"
    if array := re.fullmatch(r"(.+)\[(\d+)\]", of):
        return f"{_type(array[1])}[{array[2]}]"
    return _WORDS.get(of, of)
