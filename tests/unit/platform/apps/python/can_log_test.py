"""CAN logs read by the Python module, compared with the recorded ticks, and with frames missing.

    can_log_test.py GLINT MODULE_FOLDER
Exit 0: all equal; 1: something differs; 77: numpy is not installed.
"""
from runs import ROOT, Runs, fields_equal, glint, main, make_run
import numpy as np

POSITION_STEP_M = 50e-6  # of the classic frame's position: can_pose_signals.hpp


class CanLogs(Runs):
    def compare(self, log, ticks, position_m, rotation, velocity_m_s, offset_ns=None):
        """Of one tool: each row is the tick's pose within these errors."""
        self.assertEqual(len(log), len(ticks))
        self.assertTrue(log["complete"].all() and log["checksum_ok"].all())
        self.assertEqual(log["lost"].sum(), 0)
        self.assertEqual(list(log["tick"]), list(ticks["tick"] - ticks["tick"][0]))
        offset_ns = self.recording.info()["unix_offset_ns"] if offset_ns is None else offset_ns
        late_ns = ticks["time_ns"] + offset_ns - log["unix_ns"]  # the log has microseconds
        self.assertTrue((0 <= late_ns.min()) and (late_ns.max() < 1000), late_ns)
        self.assertEqual(list(log["state"]), list(ticks["state"]))
        has = log["valid"]
        self.assertEqual(list(has), list(~np.isnan(ticks["position_m"][:, 0])))
        self.assertGreater(has.sum(), 50)
        near = {name: np.abs(log[name][has] - ticks[name][has]).max()
                for name in ("position_m", "velocity_m_s")}
        self.assertLessEqual(near["position_m"], position_m)
        self.assertLessEqual(near["velocity_m_s"], velocity_m_s)
        cosine = np.abs(np.sum(log["orientation_xyzw"][has] * ticks["orientation_xyzw"][has],
                               axis=1))
        self.assertLessEqual(2 * np.arccos(np.minimum(cosine, 1)).max(), rotation)

    def test_are_the_ticks_within_half_a_step(self):
        log = glint.read_can_log(str(Runs.full / "can.log"), str(ROOT / "full.toml"))
        for tool, name in enumerate(self.recording.info()["tools"]):
            self.compare(log[log["tool"] == tool], self.recording.tick_poses(name),
                         POSITION_STEP_M / 2 * 1.001, np.radians(0.0037), 0.0006)

    def test_of_fd_frames_are_the_ticks(self):
        folder = make_run("fd", can="[can]\nframes = \"fd\"\n")
        log = glint.read_can_log(str(folder / "can.log"), str(ROOT / "fd.toml"))
        recording = glint.open(str(folder / "run.mcap"))
        self.compare(log[log["tool"] == 0], recording.tick_poses("pen"), 1e-6, 1e-6, 1e-4,
                     recording.info()["unix_offset_ns"])

    def test_mark_losses_and_damage(self):
        lines = (Runs.full / "can.log").read_text().splitlines(keepends=True)
        cell = str(ROOT / "full.toml")
        whole = glint.read_can_log(str(Runs.full / "can.log"), cell)
        pen = whole[whole["tool"] == 0]
        of_pen = [i for i, line in enumerate(lines) if " 1A0#" in line]

        def without(start, count):  # all frames of the pen at `count` ticks
            gone = set()
            for first in of_pen[start:start + count]:
                gone.update(range(first, first + 5))
            return [line for i, line in enumerate(lines) if i not in gone]

        path = ROOT / "lossy.log"
        for start, count in ((10, 1), (10, 14), (10, 15), (10, 16), (20, 47)):
            path.write_text("".join(without(start, count)))
            log = glint.read_can_log(str(path), cell)
            log = log[log["tool"] == 0]
            self.assertEqual(len(log), len(pen) - count)
            self.assertEqual(list(log["lost"].nonzero()[0]), [start])
            self.assertEqual(log["lost"][start], count)
            self.assertEqual(list(log["tick"]), list(np.delete(pen["tick"],
                                                               range(start, start + count))))

        damaged = list(lines)
        at = of_pen[30] + 1  # the orientation: a wrong bit
        damaged[at] = damaged[at][:-2] + ("1" if damaged[at][-2] != "1" else "2") + "\n"
        del damaged[of_pen[40] + 4]  # the quality is missing
        path.write_text("".join(damaged))
        log = glint.read_can_log(str(path), cell)
        log = log[log["tool"] == 0]
        self.assertEqual(len(log), len(pen))
        self.assertEqual(list((~log["checksum_ok"]).nonzero()[0]), [30])
        self.assertEqual(list((~log["complete"]).nonzero()[0]), [30, 40])
        self.assertTrue(np.isnan(log["orientation_xyzw"][30]).all())
        self.assertEqual(list(log["position_m"][30]), list(pen["position_m"][30]))
        self.assertTrue(np.isnan(log["age_s"][40]))
        self.assertEqual(log["lost"].sum(), 0)

    def test_name_the_line_that_is_wrong(self):
        lines = (Runs.full / "can.log").read_text().splitlines(keepends=True)
        skipped = ["(1.000000) can0 123#R\n", "(1.000000) can0 20000080#0000000000000000\n"]
        path = ROOT / "wrong.log"
        path.write_text("".join(lines[:5] + skipped + lines[5:]))
        fields_equal(self, glint.read_can_log(str(path), str(ROOT / "full.toml")),
                     glint.read_can_log(str(Runs.full / "can.log"), str(ROOT / "full.toml")))
        for wrong in ("nonsense\n", "\n", lines[7][:-2], "(1.0) can0 1A0#00\n",
                      "(1.000000) can0 1A0#0\n"):
            path.write_text("".join(lines[:7] + [wrong]))
            with self.assertRaisesRegex(glint.InputError, r"wrong\.log:8: "):
                glint.read_can_log(str(path))


if __name__ == "__main__":
    main()
