"""Elements of scene files: names, values and parameters."""

import re
from xml.etree import ElementTree


def snake_case(name):
    return re.sub(r"([A-Z]+)", lambda m: "_" + m.group(1).lower(), name)


def name_of(node):
    """The name of a parameter as Mitsuba 3 spells it, whatever the version of the file."""
    return snake_case(node.get("name", ""))


def defaults_of(root):
    return {node.get("name"): node.get("value") for node in root.iter("default")}


def value_of(text, defaults):
    """An attribute's value with its variables (`$name`) replaced; None if one has no default."""
    try:
        return re.sub(r"\$(\w+)", lambda m: defaults[m[1]], text)
    except KeyError:
        return None


def number_of(node, text):
    """A parameter's value as a number; the node is for the message."""
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{node.tag} {node.get('type')}: expected a number, found {text}") from None


def set_number(node, name, value):
    drop(node, {name})
    ElementTree.SubElement(node, "float", name=name, value=str(value))


def drop(node, names):
    for child in list(node):
        if name_of(child) in names:
            node.remove(child)
