"""Write the TypeScript types of the API from its schema: ``python viewer/scripts/make_types.py``.

One interface for each model of `halfway.server.schema`; the tests check that the committed file is current.
"""

import inspect
import json
from pathlib import Path
from typing import Any

from halfway.server import schema

TARGET = Path(__file__).parents[1] / "src" / "api" / "schema.ts"
HEAD = "// Written by viewer/scripts/make_types.py from halfway.server.schema. Do not edit.\n"


def types() -> str:
    """The whole file."""
    models = [
        value
        for value in vars(schema).values()
        if inspect.isclass(value) and issubclass(value, schema.Model) and value is not schema.Model
    ]
    return HEAD + "".join(
        _interface(model.__name__, model.model_json_schema(mode="serialization"))
        for model in models
    )


def _interface(name: str, document: dict[str, Any]) -> str:
    text = _comment(document.get("description", ""), "")
    fields = "".join(
        f"  readonly {key}{_left_out(value)}: {_type(value)};\n"
        for key, value in document.get("properties", {}).items()
    )
    return f"\n{text}export interface {name} {{\n{fields}}}\n"


def _left_out(node: dict[str, Any]) -> str:
    """A mark where null is the same as nothing."""
    return "?" if "default" in node and node["default"] is None else ""


def _comment(text: str, indent: str) -> str:
    first = text.strip().splitlines()[0] if text.strip() else ""
    return f"{indent}/** {first} */\n" if first else ""


def _type(node: dict[str, Any]) -> str:
    if "$ref" in node:
        return node["$ref"].rpartition("/")[2]
    if "const" in node:
        return json.dumps(node["const"])
    if "enum" in node:
        return " | ".join(json.dumps(value) for value in node["enum"])
    if "anyOf" in node:
        return " | ".join(_type(option) for option in node["anyOf"])
    match node.get("type"):
        case "string":
            return "string"
        case "number" | "integer":
            return "number"
        case "null":
            return "null"
        case "boolean":
            return "boolean"
        case "array" if "prefixItems" in node:
            return f"readonly [{', '.join(_type(item) for item in node['prefixItems'])}]"
        case "array":
            return f"readonly {_element(_type(node['items']))}[]"
        case "object":
            return f"Readonly<Record<string, {_type(node['additionalProperties'])}>>"
        case other:
            raise ValueError(f"no TypeScript type for {other!r} in {node}")


def _element(text: str) -> str:
    return f"({text})" if " " in text else text


if __name__ == "__main__":
    TARGET.write_text(types())
