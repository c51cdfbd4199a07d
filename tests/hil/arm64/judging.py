"""What the judges of the emulated board share: sentences that must hold, and tables."""

wrong = []


def must(sentence, holds, found=""):
    if not holds:
        wrong.append(f"{sentence}; found {found}" if found != "" else sentence)


def say_what_is_wrong():
    for sentence in wrong:
        print("WRONG:", sentence)
    return 1 if wrong else 0


def spread(name, row):
    columns = (row["p50"], row["p99_9"], row["max"])
    print(f"  {name:<28}" + "".join(f"{value:>12.1f}" for value in columns) + f"{row['n']:>9}")


def heading(text):
    print(f"{text:<30}" + "".join(f"{name:>12}" for name in ("p50", "p99.9", "max")) + f"{'n':>9}")


def judge_run(name, run, frames):
    must(f"{name} processes every frame", run["frames"] == frames, run["frames"])
    must(f"{name} has worst inputs", run["frames_worst"] > frames // 20, run["frames_worst"])
    must(f"{name} tracks the pen", run["frames_tracked"] > frames // 2, run["frames_tracked"])
    must(f"{name} sends all CAN frames", run["can"]["dropped"] + run["can"]["failed"] == 0)
    must(f"{name} counts allocations", run["heap_counted"])
    must(f"{name} allocates nothing", run["heap_allocations"] == 0, run["heap_allocations"])
    must(f"{name} meets no page fault", run["page_faults"] == 0, run["page_faults"])
    must(f"{name} skips no tick", run["ticks_skipped"] == 0, run["ticks_skipped"])
    must(f"{name} has its rights", not run["best_effort"], run["best_effort"])
    must(f"{name} keeps every latency", run["latencies_left_out"] == 0)


def print_latencies(run):
    heading("observed, us")
    for name, key in (("frame to CAN", "frame_to_can_us"), ("computing", "computing_us"),
                      ("sampling", "sampling_us"), ("sending", "sending_us")):
        spread(name, run[key])


def judge_bound(results, check):
    chain = next(c for c in check["chains"] if c["name"] == "frame_to_can")
    bound = chain["bound_us"]
    estimate = sum(s["us"] for s in chain["stages"] if s["kind"] == "estimate")
    print(f"  bound for this board: {bound:.1f} us, {estimate:.1f} of it the system's share, "
          f"an estimate (costs {check['board']} {check['board_sha256'][:12]})")
    for name, run in results:
        for figure in ("p99_9", "max"):
            observed = run["frame_to_can_us"][figure]
            must(f"{name}: frame to CAN {figure} stays below {bound:.1f} us", observed < bound,
                 observed)
