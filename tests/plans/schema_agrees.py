#!/usr/bin/env python3
"""The published schema and the reader agree, by an independent validator (python3-jsonschema).

Every example plan must validate. A bad plan must be refused by the schema when one of its codes is
a fault of structure, and must validate when none is. Repeated keys and text that is not JSON are
beyond a schema.

usage: schema_agrees.py REPOSITORY
"""

import copy
import json
import pathlib
import sys

import jsonschema

STRUCTURE = {"unknown-key", "wrong-unit", "wrong-type", "out-of-range", "units", "bad-option"}
# Both tables and meaning checks give these: the schema may refuse, or may not know.
EITHER = {"missing-key", "pose-range", "step"}


def patched(plan, patch):
    """Changes a plan by a JSON patch (RFC 6902) of "add", "replace", "remove" and "copy"."""
    for operation in patch:
        if operation["op"] == "copy":
            value = plan
            for name in operation["from"].split("/")[1:]:
                value = value[int(name)] if isinstance(value, list) else value[name]
            operation = {"op": "add", "path": operation["path"], "value": copy.deepcopy(value)}
        names = operation["path"].split("/")[1:]
        *way, last = [name.replace("~1", "/").replace("~0", "~") for name in names]
        at = plan
        for name in way:
            at = at[int(name)] if isinstance(at, list) else at[name]
        if isinstance(at, list):
            last = len(at) if last == "-" else int(last)
        if operation["op"] == "remove":
            del at[last]
        elif operation["op"] == "add" and isinstance(at, list):
            at.insert(last, operation["value"])
        else:
            at[last] = operation["value"]
    return plan


def disagreement(row, base, validator):
    codes = {problem.split()[0] for problem in row["problems"]}
    refused = not validator.is_valid(patched(base, row["patch"]))
    if codes & STRUCTURE and not refused:
        return "the schema accepts what the reader refuses"
    if not codes & (STRUCTURE | EITHER) and refused:
        return "the schema refuses what is no fault of structure"
    return None


def main(root):
    schema = json.loads((root / "plans/schema/plan.schema.json").read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    examples = sorted((root / "plans/examples").glob("*.json"))
    folder = root / "tests/data/bad_plans"
    bad = [row for row in json.loads((folder / "bad_plans.json").read_text()) if "patch" in row]
    faults = [
        f"{plan.name}: {error.json_path}: {error.message}"
        for plan in examples
        for error in validator.iter_errors(json.loads(plan.read_text()))
    ]
    for row in bad:
        fault = disagreement(row, json.loads((folder / row["base"]).read_text()), validator)
        if fault:
            faults.append(f"{row['name']}: {fault}")
    print(f"{len(examples)} examples, {len(bad)} bad plans, {len(faults)} disagreements")
    print("\n".join(faults))
    return 1 if faults or not examples or not bad else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
