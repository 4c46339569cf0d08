"""Checks case files against a schema; prints their first errors as JSON."""

import json
import sys
import tomllib

from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match


def subschemas(schema, place=""):
    """Every schema inside one, with its place."""
    if isinstance(schema, dict):
        yield place, schema
        for name, inner in schema.items():
            if name not in ("default", "examples", "enum"):
                yield from subschemas(inner, f"{place}/{name}")
    elif isinstance(schema, list):
        for number, inner in enumerate(schema):
            yield from subschemas(inner, f"{place}/{number}")


with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
Draft202012Validator.check_schema(schema)
shown = {}
for place, inner in subschemas(schema):
    if "description" not in inner or place.endswith("/properties"):
        continue
    for value in inner.get("examples", []) + [inner[name] for name in ("default",) if name in inner]:
        error = best_match(Draft202012Validator(inner).iter_errors(value))
        if error is not None:
            shown[place] = f"{value}: {error.message}"

cases = {}
validator = Draft202012Validator(schema)
for path in sys.argv[2:]:
    with open(path, "rb") as file:
        try:
            case = tomllib.load(file)
        except tomllib.TOMLDecodeError as error:
            cases[path] = f"not TOML: {error}"
            continue
    error = best_match(validator.iter_errors(case))
    cases[path] = None if error is None else f"{error.json_path}: {error.message}"
print(json.dumps({"shown": shown, "cases": cases}))
