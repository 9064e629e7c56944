#!/usr/bin/env python3
"""The published schema and the reader agree, by an independent validator (python3-jsonschema).

Every example plan must validate. A bad plan must be refused by the schema when its .expected file
names a fault of structure, and must validate when it names none. Repeated keys and text that is not
JSON are beyond a schema.

usage: schema_agrees.py REPOSITORY
"""

import json
import pathlib
import sys

import jsonschema

STRUCTURE = {"unknown-key", "wrong-unit", "wrong-type", "out-of-range", "units", "bad-option"}
# Both tables and meaning checks give these: the schema may refuse, or may not know.
EITHER = {"missing-key", "pose-range", "step"}
BEYOND_SCHEMA = {"syntax", "repeated-key"}


def codes_of(expected):
    return {line.split()[0] for line in expected.read_text().splitlines()}


def disagreement(plan, validator):
    codes = codes_of(plan.with_suffix(".expected"))
    if codes & BEYOND_SCHEMA:
        return None
    refused = not validator.is_valid(json.loads(plan.read_text()))
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
    bad = sorted((root / "plans/examples/bad").glob("*.json"))
    faults = [
        f"{plan.name}: {error.json_path}: {error.message}"
        for plan in examples
        for error in validator.iter_errors(json.loads(plan.read_text()))
    ]
    for plan in bad:
        fault = disagreement(plan, validator)
        if fault:
            faults.append(f"{plan.name}: {fault}")
    print(f"{len(examples)} examples, {len(bad)} bad plans, {len(faults)} disagreements")
    print("\n".join(faults))
    return 1 if faults or not examples or not bad else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
