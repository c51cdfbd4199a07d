"""Values of the Python module, compared with the commands and with independent readers.

    python_test.py GLINT MODULE_FOLDER
Exit 0: all equal; 1: something differs; 77: numpy is not installed.
"""
import threading

from runs import ROOT, Runs, fields_equal, glint, main, make_run, numbers, rows_of, run
import mcap_format
import numpy as np


class FramePoses(Runs):
    def test_are_those_of_export_csv(self):
        for origin, option in (("tool", []), ("tip", ["--of-tip"])):
            path = ROOT / f"{origin}.csv"
            run("export", "csv", Runs.full / "run.mcap", "--out", path, *option)
            rows = rows_of(path)
            poses = self.recording.frame_poses(origin=origin)
            self.assertEqual(len(rows), len(poses))
            measured = 0
            for row, pose in zip(rows, poses):
                self.assertEqual(row["state"], glint.STATES[pose["state"]])
                self.assertEqual(row["reason"], glint.REASONS[pose["reason"]])
                self.assertEqual(row["tool"], self.recording.info()["tools"][pose["tool"]])
                self.assertEqual(int(row["sequence"]), pose["sequence"])
                if row["state"] != "measured":
                    self.assertTrue(np.isnan(pose["position_m"]).all())
                    self.assertTrue(np.isnan(pose["covariance"]).all())
                    continue
                measured += 1
                self.assertEqual(row["frame"], glint.REFERENCE_FRAMES[pose["frame"]])
                self.assertEqual(int(row["marker_mask"]), pose["marker_mask"])
                self.assertEqual(float(row["rms_m"]), pose["rms_m"])
                self.assertEqual(numbers(row, "x_m", "y_m", "z_m"), list(pose["position_m"]))
                self.assertEqual(numbers(row, "qx", "qy", "qz", "qw"),
                                 list(pose["orientation_xyzw"]))
                sigmas = numbers(row, "sigma_x_m", "sigma_y_m", "sigma_z_m", "sigma_rx_rad",
                                 "sigma_ry_rad", "sigma_rz_rad")
                self.assertEqual(sigmas, list(np.sqrt(np.diag(pose["covariance"]))))
            self.assertGreater(measured, 50)

    def test_of_one_tool_are_its_rows(self):
        poses = self.recording.frame_poses()
        fields_equal(self, self.recording.frame_poses("board"), poses[poses["tool"] == 1])


class Trackers(Runs):
    def track_all(self, cell, out):
        tracker = glint.Tracker(cell)
        for frame in self.recording.frames():
            out.append(tracker.track(frame.reflectivity, frame.depth, frame.time_ns,
                                     frame.head_pose, frame.sequence, frame.stamp_sigma_ns))

    def test_give_the_bits_of_the_recording_also_two_at_once(self):
        expected = self.recording.frame_poses()
        cells = [self.recording, self.recording.cell_text, str(ROOT / "full.toml")]
        outputs = [[] for _ in cells]
        threads = [threading.Thread(target=self.track_all, args=pair)
                   for pair in zip(cells, outputs)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for output in outputs:
            fields_equal(self, np.concatenate(output), expected)

    def test_take_a_matrix_and_no_head_pose(self):
        frame = next(iter(self.recording.frames()))
        x, y, z, w = frame.head_pose[3:]
        matrix = np.eye(4)
        matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                          [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                          [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        matrix[:3, 3] = frame.head_pose[:3]
        given = [glint.Tracker(self.recording).track(frame.reflectivity, frame.depth, 0, head)[0]
                 for head in (frame.head_pose, matrix, None)]
        self.assertTrue(np.allclose(given[0]["position_m"], given[1]["position_m"], atol=1e-12))
        self.assertEqual([glint.REFERENCE_FRAMES[pose["frame"]] for pose in given],
                         ["world", "world", "camera"])
        in_world = matrix[:3, :3] @ given[2]["position_m"] + matrix[:3, 3]
        self.assertTrue(np.allclose(in_world, given[0]["position_m"], atol=1e-9))

    def test_refuse_a_frame_twice(self):
        tracker = glint.Tracker(self.recording)
        frame = next(iter(self.recording.frames()))
        images = (frame.reflectivity, frame.depth, frame.time_ns)
        self.assertEqual(glint.STATES[tracker.track(*images, sequence=7)[0]["state"]], "measured")
        again = tracker.track(*images, sequence=7)[0]
        self.assertEqual((glint.STATES[again["state"]], glint.REASONS[again["reason"]]),
                         ("none", "frame_doubled"))

    def test_refuse_wrong_images_and_head_poses(self):
        tracker = glint.Tracker(self.recording)
        frame = next(iter(self.recording.frames()))
        bright, depth = frame.reflectivity, frame.depth
        self.assertEqual(tracker.shape, bright.shape)
        nan = np.full(7, np.nan)
        for images, head, wrong in (
                ((bright.astype(np.uint8), depth), None, "reflectivity: dtype uint8"),
                ((bright, depth.astype(np.float32)), None, "depth: dtype float32"),
                ((bright[:9], depth), None, r"reflectivity: shape \(9, 512\)"),
                ((bright, depth[0]), None, r"depth: shape \(512\)"),
                ((bright.T, depth), None, "reflectivity: not C-contiguous"),
                ((bright, depth), nan, "head_pose: a number is not finite"),
                ((bright, depth), np.diag([1, 1, np.inf, 1]), "head_pose: a number is not finite"),
                ((bright, depth), 2 * np.eye(4), "head_pose: not a rigid transform"),
                ((bright, depth), np.diag([1, 1, -1, 1]), "head_pose: not a rigid transform"),
                ((bright, depth), np.arange(7), "head_pose: not a unit quaternion"),
                ((bright, depth), np.eye(3), r"head_pose: shape \(3, 3\)"),
                ((bright, depth), "here", "head_pose: not numbers")):
            with self.assertRaisesRegex(glint.InputError, wrong):
                tracker.track(*images, 0, head)


class Frames(Runs):
    def test_are_those_of_an_independent_reader(self):
        width, height, expected = mcap_format.read_recording(Runs.full / "run.mcap")
        frames = list(self.recording.frames())
        self.assertEqual(len(frames), len(expected))
        heads = self.recording.head_poses()
        for frame, other, head in zip(frames, expected, heads):
            self.assertEqual(frame.time_ns, other.stamp_ns)
            self.assertEqual(frame.sequence, other.sequence)
            self.assertEqual(frame.depth.shape, (height, width))
            self.assertEqual(frame.reflectivity.tobytes(), other.bright.tobytes())
            self.assertEqual(frame.depth.tobytes(), other.depth.tobytes())
            self.assertEqual(tuple(frame.head_pose), (*other.pose[0], *other.pose[1]))
            self.assertEqual(tuple(frame.head_pose),
                             (*head["position_m"], *head["orientation_xyzw"]))

    def test_of_a_level_without_pixels_are_refused(self):
        folder = make_run("blobs", "--record-level", "blobs")
        recording = glint.open(str(folder / "run.mcap"))
        with self.assertRaisesRegex(glint.InputError, "level blobs holds no frames"):
            recording.frames()
        blobs = recording.blobs()
        self.assertTrue(np.allclose(np.linalg.norm(blobs["ray"], axis=1), 1))
        times = {head["time_ns"] for head in self.recording.head_poses()}
        self.assertEqual(set(blobs["time_ns"]) - times, set())
        fields_equal(self, recording.tick_poses(), self.recording.tick_poses())


class TickPoses(Runs):
    def test_are_the_rows_of_the_csv_file(self):
        rows = rows_of(Runs.full / "samples.csv")
        poses = self.recording.tick_poses()
        self.assertEqual(len(rows), len(poses))
        names = [f"c{i}{j}" for i in range(1, 7) for j in range(1, 7)]
        with_pose = 0
        for row, pose in zip(rows, poses):
            self.assertEqual(row["state"], glint.STATES[pose["state"]])
            self.assertEqual(row["reason"], glint.REASONS[pose["reason"]])
            self.assertEqual(row["registration"], glint.REGISTRATIONS[pose["registration"]])
            self.assertEqual(row["frame"], glint.REFERENCE_FRAMES[pose["frame"]])
            self.assertEqual(int(row["tick_number"]), pose["tick"])
            self.assertEqual(int(row["tool"]), pose["tool"])
            self.assertEqual(round(float(row["tick_s"]) * 1e9), pose["time_ns"])
            if row["x_m"] == "":
                self.assertTrue(np.isnan(pose["position_m"]).all())
                continue
            with_pose += 1
            self.assertEqual(numbers(row, "x_m", "y_m", "z_m"), list(pose["position_m"]))
            self.assertEqual(numbers(row, "qx", "qy", "qz", "qw"), list(pose["orientation_xyzw"]))
            self.assertEqual(numbers(row, "vx_m_s", "vy_m_s", "vz_m_s"),
                             list(pose["velocity_m_s"]))
            self.assertEqual(numbers(row, "wx_rad_s", "wy_rad_s", "wz_rad_s"),
                             list(pose["angular_velocity_rad_s"]))
            # The record holds the lower half of a symmetric matrix.
            self.assertTrue(np.allclose(numbers(row, *names), pose["covariance"].ravel(),
                                        rtol=1e-12, atol=1e-18))
            self.assertTrue(np.allclose(
                numbers(row, *(f"systematic_{name}" for name in names)),
                pose["systematic"].ravel(), rtol=1e-12, atol=1e-18))
        self.assertGreater(with_pose, 100)

    def test_come_in_the_order_of_the_messages(self):
        messages = list(self.recording)
        ticks = [value for kind, value in messages if kind == "tick_pose"]
        fields_equal(self, np.array(ticks, dtype=glint.TICK_POSE), self.recording.tick_poses())
        kinds = {kind for kind, _ in messages}
        self.assertEqual(kinds, {"frame", "head_pose", "choice", "tick_pose"})
        self.assertEqual(len(self.recording.choices()),
                         sum(kind == "choice" for kind, _ in messages))


class Errors(Runs):
    def test_are_the_lines_of_the_commands(self):
        whole = (Runs.full / "run.mcap").read_bytes()
        path = ROOT / "damaged.mcap"
        flipped = bytearray(whole)
        flipped[len(whole) // 2] ^= 4
        for content in (whole[:len(whole) // 3], b"", b"not a recording" * 10, bytes(flipped)):
            path.write_bytes(content)
            line = run("replay", path, code=2).stderr.strip().splitlines()[-1]
            with self.assertRaises(glint.Error) as caught:
                glint.open(str(path)).tick_poses()
            self.assertIsInstance(caught.exception, ValueError)
            self.assertEqual("glint: " + str(caught.exception), line)

    def test_count_what_a_truncated_recording_lacks(self):
        whole = (Runs.full / "run.mcap").read_bytes()
        path = ROOT / "short.mcap"
        path.write_bytes(whole[:len(whole) // 2])
        ticks = glint.open(str(path), allow_truncated=True)
        part, all_ticks = ticks.tick_poses(), self.recording.tick_poses()
        self.assertTrue(0 < len(part) < len(all_ticks))
        fields_equal(self, part, all_ticks[:len(part)])
        self.assertGreater(ticks.losses()["bytes"] + ticks.losses()["messages"], 0)
        self.assertEqual(self.recording.losses()["bytes"], 0)

    def test_name_what_is_wrong(self):
        missing = str(ROOT / "none")
        for call, kind, wrong in (
                (lambda: glint.open(missing), glint.InputError, "none: No such file"),
                (lambda: glint.Tracker(missing), glint.InputError, "none: cannot be read"),
                (lambda: glint.Tracker("a = 1\n"), glint.InputError, "cell:1: unknown key a"),
                (lambda: glint.Tracker(origin="top"), glint.InputError, "origin: \"top\""),
                (lambda: self.recording.tick_poses("pem"), glint.InputError, "one of pen, board"),
                (lambda: self.recording.attachment("x"), glint.InputError, "expected cell.toml"),
                (lambda: glint.read_can_log(missing), glint.InputError, "none: No such file"),
                (lambda: glint.experiment("statik"), glint.InputError, "did you mean static"),
                (lambda: glint.experiment("lag", lab=missing), glint.Error, "none'; expected")):
            with self.assertRaisesRegex(kind, wrong):
                call()

    def test_of_an_experiment_are_its_last_line(self):
        lab = ROOT / "lab"
        lab.write_text("#!/bin/sh\necho table\necho first >&2\necho the bar is missed >&2\nexit 1\n")
        lab.chmod(0o755)
        with self.assertRaises(glint.Error) as caught:
            glint.experiment("lag", lab=str(lab))
        self.assertNotIsInstance(caught.exception, ValueError)
        self.assertEqual(str(caught.exception),
                         "experiment lag: exit code 1: the bar is missed")

    def test_of_an_experiment_are_none_where_it_succeeds(self):
        lab = ROOT / "lab"
        lab.write_text('#!/bin/sh\n[ "$*" = "experiment lag --seed 3 --quick --out $7 --json $9" ] '
                       '&& printf \'{"words": "%s"}\' "$*" > "$9"\n')
        lab.chmod(0o755)
        figures = glint.experiment("lag", lab=str(lab), seed=3, quick=True, loud=False)
        self.assertTrue(figures["words"].startswith("experiment lag --seed 3 --quick --out "))


if __name__ == "__main__":
    main()
