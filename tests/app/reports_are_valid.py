#!/usr/bin/python3
"""report.json follows its published schema, by an independent validator (python3-jsonschema).

Two checks of each file: it validates, and the schema describes every key that it holds, so that no
number is written that the documentation does not know.

usage: reports_are_valid.py SCHEMA RUN_DIR...
"""

import json
import pathlib
import sys

import jsonschema


def branches(schema, root):
    """The plain schemas that may describe a value: references and alternatives followed."""
    if "$ref" in schema:
        name = schema["$ref"].removeprefix("#/definitions/")
        yield from branches(root["definitions"][name], root)
        return
    yield schema
    for key in ("anyOf", "allOf"):
        for other in schema.get(key, []):
            yield from branches(other, root)
    for key in ("then", "else"):
        if key in schema:
            yield from branches(schema[key], root)


def undescribed(value, schemas, root, where):
    """Keys that none of the schemas describes; an object without properties is described whole."""
    plain = [b for s in schemas for b in branches(s, root)]
    if isinstance(value, list):
        items = [b["items"] for b in plain if "items" in b]
        for i, item in enumerate(value):
            if items:
                yield from undescribed(item, items, root, f"{where}/{i}")
    elif isinstance(value, dict):
        tables = [b["properties"] for b in plain if "properties" in b]
        open_ended = any("additionalProperties" in b for b in plain)
        for key, inner in value.items():
            known = [t[key] for t in tables if key in t]
            if known:
                yield from undescribed(inner, known, root, f"{where}/{key}")
            elif tables and not open_ended:
                yield f"{where}/{key} is not described"


def faults_of(run, schema):
    file = run / "report.json"
    report = json.loads(file.read_text(encoding="utf-8"))
    for error in jsonschema.Draft7Validator(schema).iter_errors(report):
        yield f"{file}: {error.json_path}: {error.message[:200]}"
    for fault in undescribed(report, [schema], schema, ""):
        yield f"{file}: {fault}"


def main(schema_file, runs):
    schema = json.loads(pathlib.Path(schema_file).read_text(encoding="utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    faults = [fault for run in runs for fault in faults_of(pathlib.Path(run), schema)]
    print(f"{len(runs)} runs, {len(faults)} faults")
    print("\n".join(faults[:20]))
    return 1 if faults or not runs else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
