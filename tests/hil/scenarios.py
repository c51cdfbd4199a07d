#!/usr/bin/env python3
"""Scenarios of tests/hil/run: the table scenarios.toml, as scripts for the board.

    scenarios.py write FOLDER SCENARIO...   FOLDER/GROUP/scripts/NAME, and FOLDER/table.json
    scenarios.py cells CELL FOLDER          the cell and its variants, for the board
SCENARIO: a name, a group, or all.
"""
import json
import pathlib
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
SPEED_MAX = 2000  # of a hand, mm/s
DEFAULT_TICK_HZ = 250
ENABLE_CYCLE_MS = 4  # the action changes in the next cycle
SETTLED_MS = 1000  # Glint tracks, and a person has enabled the motion
VARIANTS = {  # of the cell: what is replaced
    "cell": [],
    "cell_1000": [("tick_hz = 250", "tick_hz = 1000")],
    "cell_at_once": [("tick_hz = 250", "tick_hz = 250\ntick_release = \"estimate\"")],
    "cell_wrong": [("[650.0, ", "[350.0, ")],
}


def load():
    table = tomllib.loads((HERE / "scenarios.toml").read_text())
    common = table["common"]
    scenarios = []
    for row in table["scenario"]:
        tick_hz = row.get("tick_hz", DEFAULT_TICK_HZ)
        ends = row.get("ends", common["ends"])
        if "ticks" in row:
            ends = SETTLED_MS + row["ticks"] * 1000 // tick_hz
        enable = row.get("enable", common["enable"])
        faults = [f"{enable} controller enable", *row.get("faults", [])]
        if not any(line.startswith("0 glint") for line in faults):
            faults.append(f"0 glint start /{row.get('cell', 'cell')}.toml")
        scenarios.append({
            "group": "faults", "losses": False, "counts": {}, "text": "", **row, "ends": ends,
            "tick_hz": tick_hz, "at_once": row.get("cell") == "cell_at_once",
            "faults": sorted(faults, key=lambda line: int(line.split()[0])),
            "expected": [f"follow {enable}..{enable + ENABLE_CYCLE_MS}", *row.get("expected", [])]})
    return scenarios


def chosen(names):
    scenarios = load()
    accepted = {"all"} | {s["name"] for s in scenarios} | {s["group"] for s in scenarios}
    for name in names:
        if name not in accepted:
            sys.exit(f"{name}: no such scenario; expected one of {', '.join(sorted(accepted))}")
    return [s for s in scenarios if {s["name"], s["group"]} & set(names) or
            "all" in names and s["group"] != "interactive"]


def write(folder, names):
    scenarios = chosen(names)
    for number, s in enumerate(scenarios):
        scripts = folder / s["group"] / "scripts"
        scripts.mkdir(parents=True, exist_ok=True)
        (scripts / s["name"]).write_text("\n".join(
            [f"cycle_us {1_000_000 // s['tick_hz']}", f"speed_max {SPEED_MAX}",
             f"ends_ms {s['ends']}", *s["faults"], ""]))
    (folder / "table.json").write_text(json.dumps(scenarios, indent=1))


def write_cells(cell, folder):
    for name, replacements in VARIANTS.items():
        text = cell.read_text()
        for old, new in replacements:
            if text.count(old) != 1:
                sys.exit(f"{cell}: expected \"{old}\" once")
            text = text.replace(old, new)
        (folder / f"{name}.toml").write_text(text)


def main():
    command, *rest = sys.argv[1:] or [""]
    if command == "write" and len(rest) >= 2:
        return write(pathlib.Path(rest[0]), rest[1:])
    if command == "cells" and len(rest) == 2:
        return write_cells(pathlib.Path(rest[0]), pathlib.Path(rest[1]))
    sys.exit(__doc__)


if __name__ == "__main__":
    main()
