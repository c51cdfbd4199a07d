#!/usr/bin/env python3
"""Judges the results of tests/hil/run against the table, prints them, writes JUnit XML and HTML.

    judge_scenarios.py FOLDER GLINT_DBC BOOTS
FOLDER/table.json: the scenarios; FOLDER/GROUP/BOOT/NAME.*: their results; FOLDER/GROUP/NAME.host, .m3:
the decoder's decisions over NAME.log on this machine and on a Cortex-M3 (.m3 may be absent).
Exit 0: passed; 1: failed.
"""
import json
import pathlib
import re
import sys

sys.dont_write_bytecode = True  # nothing is left beside the sources
from can_log import measured_ages
from recording_end import end_of_last_chunk
from scenario_report import write_html, write_junit

ACTION = re.compile(r"(follow|ramp|stop)$")
AGE_SLACK_MS = 2.0  # the last of five frames is sent after the tick, and the camera's clock estimated
BAR_SLACK_MS = 0.5
FIRST_SETS = 2  # a sequence begins with its third set
NEVER = ("wrong_format", "wrong_check", "incomplete", "repeated", "too_old", "implausible")
LOST_MAX_S = 2  # a recording's chunk spans a second, and is synchronised each second


def lines_of(file):
    return [(int(time), what) for time, what in
            (line.split(" ", 1) for line in file.read_text().splitlines())]


def first_cycle(events):
    return next(time for time, what in lines_of(events) if what == "first cycle")


def transitions(stem):
    """(milliseconds from the start, action): the changes after the first stop."""
    start = first_cycle(stem.with_suffix(".events"))
    return [((time - start) / 1000, what) for time, what in
            lines_of(stem.with_suffix(".decisions")) if ACTION.match(what)]


def counts_of(decisions):
    """Verdicts, summed over the controller's starts."""
    counts = {}
    for number, what in lines_of(decisions):
        if " " not in what and not ACTION.match(what) and what not in ("enabled", "restarted"):
            counts[what] = counts.get(what, 0) + number
    return counts


def judge_sequence(scenario, found, must):
    must("the robot begins stopped", found[:1] and found[0][1] == "stop", found[:1])
    found = found[1:]
    expected = scenario["expected"]
    must("the actions are the expected ones", [what for _, what in found] ==
         [line.split()[0] for line in expected], " ".join(what for _, what in found) or "none")
    for line, (at, what) in zip(expected, found):
        low, high = (int(number) for number in line.split()[1].split(".."))
        must(f"{line} ms", low <= at <= high, f"{what} {at:.0f}")


def judge_glint(scenario, figures, must):
    lost = [loss["text"] for loss in figures["losses"]]
    must("Glint counts its losses" if scenario["losses"] else "Glint loses nothing",
         bool(lost) == scenario["losses"], "; ".join(lost) or "none")
    if scenario["group"] != "normal":
        return
    tick_ms = 1000 / scenario["tick_hz"]
    total, computing = figures["frame_to_can_us"], figures["computing_us"]
    bar_ms = (0 if scenario["at_once"] else tick_ms) + computing["p99_9"] / 1000 + BAR_SLACK_MS
    must(f"frame to CAN p99.9 at most {bar_ms:.2f} ms", total["p99_9"] / 1000 <= bar_ms,
         total["p99_9"])
    must("no late tick", figures["ticks_late"] + figures["ticks_skipped"] == 0,
         figures["ticks_late"])
    must("enough ticks", figures["output"]["ticks_sent"] >= scenario["ticks"],
         figures["output"]["ticks_sent"])
    print(f"  {scenario['name']}: {figures['output']['ticks_sent']} ticks of {tick_ms:g} ms, "
          f"{figures['ticks_late']} late; frame to CAN p50 {total['p50']:.0f}, p99.9 "
          f"{total['p99_9']:.0f}, max {total['max']:.0f} us; computing p99.9 "
          f"{computing['p99_9']:.0f} us; n {total['n']}; bar {bar_ms * 1000:.0f} us")


def judge_ages(stem, dbc, must):
    """Nothing `measured` is older than its age: no set is of a frame after the newest delivered one."""
    deliveries = lines_of(stem.with_suffix(".frames"))
    oldest = 0.0
    next_delivery, newest_exposure_ms = 0, 0.0
    for at_us, age_ms in measured_ages(stem.with_suffix(".log"), dbc):
        while next_delivery < len(deliveries) and deliveries[next_delivery][0] <= at_us * 1000:
            newest_exposure_ms = int(deliveries[next_delivery][1]) / 1e6
            next_delivery += 1
        oldest = max(oldest, at_us / 1000 - newest_exposure_ms - age_ms)
    must("no measured set is older than its age", oldest <= AGE_SLACK_MS, f"{oldest:.1f} ms")


def judge_power_cut(folder, boots, must):
    """The recording that the next start found on the disk."""
    for boot in range(1, boots + 1):
        console = (folder / "power_cut" / f"console-{boot}.log").read_text(errors="replace")
        cut = re.search(r"power off at (\d+) ns", console)
        part = folder / "power_returns" / str(boot) / "run.mcap.part"
        must("the power is cut", cut)
        must("the recording is kept", part.exists())
        if cut and part.exists():
            lost_s = (int(cut[1]) - end_of_last_chunk(part)) / 1e9
            must(f"it ends less than {LOST_MAX_S} s before the cut", 0 <= lost_s < LOST_MAX_S,
                 f"{lost_s:.3f} s")
            print(f"  power_cut: the recording of {part.stat().st_size} bytes ends {lost_s:.3f} s "
                  "before the cut")


def judge(scenario, folder, dbc, boots):
    wrong = []

    def must(sentence, holds, found=""):
        if not holds:
            wrong.append(f"{sentence}; found {found}" if found != "" else sentence)

    if scenario["name"] == "power_cut":  # nothing but the disk remains
        judge_power_cut(folder, boots, must)
        return wrong, []
    group = folder / scenario["group"]
    stems = [group / str(boot) / scenario["name"] for boot in range(1, boots + 1)]
    missing = [str(s) for s in stems if not s.with_suffix(".decisions").exists()]
    if missing:
        return [f"no result: {', '.join(missing)}"], []
    texts = [stem.with_suffix(".decisions").read_text() for stem in stems]
    must(f"{boots} boots decide alike", len(set(texts)) == 1)
    for where in ("host", "m3"):
        file = group / f"{scenario['name']}.{where}"
        must(f"the decisions over the log are the same ({where})",
             not file.exists() or file.read_text() == texts[0])
    found = transitions(stems[0])
    judge_sequence(scenario, found, must)
    counts = counts_of(stems[0].with_suffix(".decisions"))
    if scenario["group"] == "normal":
        must(f"the controller rejects no set but the first {FIRST_SETS}",
             not any(counts.get(name) for name in NEVER) and
             counts.get("jumped", 0) <= FIRST_SETS, counts)
    for name, low in scenario["counts"].items():
        must(f"at least {low} {name}", counts.get(name, 0) >= low, counts.get(name, 0))
    figures = sorted(stems[0].parent.glob(scenario["name"] + "*.json"))
    must("Glint's figures exist", bool(figures))
    if figures:
        judge_glint(scenario, json.loads(figures[-1].read_text()), must)
    if not any("bus delay" in line or "bus repeat" in line or "slow" in line
               for line in scenario["faults"]):
        judge_ages(stems[0], dbc, must)
    return wrong, found


def main(folder, dbc, boots):
    results = []
    for scenario in json.loads((folder / "table.json").read_text()):
        wrong, found = judge(scenario, folder, dbc, boots)
        cycle_ms = 1000 / scenario["tick_hz"]
        results.append({**scenario, "wrong": wrong, "found": found, "cycle_ms": cycle_ms})
    for group in {result["group"] for result in results}:  # in the order of their boot
        end = (folder / group / "started").stat().st_mtime
        for result in sorted((r for r in results if r["group"] == group), key=lambda r: r["name"]):
            file = folder / group / "1" / f"{result['name']}.decisions"
            began, end = end, file.stat().st_mtime if file.exists() else end
            result["wall_s"] = end - began
    for result in results:
        sequence = ", ".join(f"{what} {at:.0f} ms (cycle {round(at / result['cycle_ms'])})"
                             for at, what in result["found"][1:])
        print(f"{'ok' if not result['wrong'] else 'WRONG':<6}{result['name']:<20}"
              f"{result['wall_s']:5.1f} s  {sequence}")
        for sentence in result["wrong"]:
            print(f"      {sentence}")
    write_junit(results, folder / "junit.xml")
    write_html(results, folder / "report.html")
    return 1 if any(result["wrong"] for result in results) else 0


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])))
