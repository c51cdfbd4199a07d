"""A new lens changes three files: the camera model's two and the reader of calibration files.

The script adds the equidistant lens of Kannala and Brandt (four coefficients, as ROS and OpenCV's
fisheye module have it) to copies of them. Rays and pixels must agree with the closed form, the
reader must compile, and with the enumerator alone the compiler must name the lens.

    new_lens.py COMPILER SOURCE
Exit 0: they do; 1: something differs.

Source: Kannala and Brandt, "A Generic Camera Model and Calibration Method for Conventional,
Wide-Angle, and Fish-Eye Lenses", IEEE PAMI 28 (2006), eq. (3).
"""
import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True
import changes

HEADER, MODEL = "kernels/pose/camera_model.hpp", "kernels/pose/camera_model.cpp"
READER = "platform/cells/calibration_files.cpp"
ENUMERATOR = ("enum class Lens : std::uint8_t { pinhole, brown, rational, lut };",
              "enum class Lens : std::uint8_t { pinhole, brown, rational, lut, equidistant };")
CHANGES = {
    HEADER: [ENUMERATOR, ("    case Lens::brown:\n", "    case Lens::equidistant:\n    case Lens::brown:\n")],
    MODEL: [
        ("Distorted distort(const CameraModel& camera", """// r(theta) = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
Distorted equidistant(const std::array<double, 8>& k, const Vector2& p) {
  const double x = p.x(), y = p.y(), r = p.norm(), angle = arc_tangent(r, 1), a2 = angle * angle;
  const double length = angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
  const double rate =
      (1 + a2 * (3 * k[0] + a2 * (5 * k[1] + a2 * (7 * k[2] + a2 * 9 * k[3])))) / (1 + r * r);
  const double factor = r > 1e-6 ? length / r : 1;
  const double slope = r > 1e-3 ? (rate - factor) / (2 * r * r) : k[0] - 1.0 / 3;
  return {p * factor, factor + 2 * x * x * slope, 2 * x * y * slope, 2 * x * y * slope,
          factor + 2 * y * y * slope};
}

Distorted distort(const CameraModel& camera"""),
        ("      return {p, 1, 0, 0, 1};\n", "      return {p, 1, 0, 0, 1};\n    case Lens::equidistant:\n"
         "      return equidistant(camera.distortion, p);\n"),
        ("    case Lens::pinhole:\n    case Lens::lut:\n      break;\n",
         "    case Lens::pinhole:\n    case Lens::lut:\n      break;\n    case Lens::equidistant:\n"
         "      return invert([&k](const Vector2& p) { return equidistant(k, p); }, camera, target,\n"
         "                    target, steps_max, steps, out);\n"),
        ('#include "kernels/pose/ray_table.hpp"',
         '#include "kernels/elementary.hpp"\n#include "kernels/pose/ray_table.hpp"'),
    ],
    READER: [
        ('{"brown", "rational"}) == "brown" ? Lens::brown : Lens::rational;',
         '{"brown", "rational", "equidistant"}) == "brown" ? Lens::brown\n'
         '      : reader.text("lens", "") == "equidistant" ? Lens::equidistant : Lens::rational;'),
    ],
}
SOURCES = ["kernels/elementary.cpp", "kernels/pose/ray_table.cpp", MODEL]
PROGRAM = """
#include <cstdio>
int main() {
  using namespace glint;
  CameraModel camera;
  camera.lens = Lens::equidistant;
  camera.fx = camera.fy = 300;
  camera.cx = camera.cy = 256;
  camera.distortion = {0.02, -0.01, 0.003, -0.001};
  double pixel_error = 0, ray_error = 0;
  int rays = 0;
  for (double angle = 0.001; angle < 1.2; angle += 0.01, ++rays) {
    const double a2 = angle * angle;
    const double r = angle * (1 + a2 * (0.02 + a2 * (-0.01 + a2 * (0.003 - 0.001 * a2))));
    const Vector2 pixel(256 + 300 * r * 0.6, 256 + 300 * r * 0.8);
    const Vector3 ray(std::sin(angle) * 0.6, std::sin(angle) * 0.8, std::cos(angle));
    const Result<Vector2> there = project(camera, 0.5 * ray);
    const Result<Vector3> back = unproject(camera, pixel);
    pixel_error = std::max(pixel_error, there ? (there.value - pixel).norm() : 1e9);
    ray_error = std::max(ray_error, back ? (back.value - ray).norm() : 1e9);
  }
  std::printf("%d rays\\n", rays);
  std::printf(pixel_error < 1e-9 ? "pixels agree\\n" : "pixels: %g px\\n", pixel_error);
  std::printf(ray_error < 1e-9 ? "rays agree\\n" : "rays: %g\\n", ray_error);
}
"""
EXPECTED = ["120 rays", "pixels agree", "rays agree"]
SWITCHES = 3  # switches over the lens


def warnings_without_cases(compiler, source):
    """How many switches the compiler names where only the enumerator was added."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        changes.changed_copies(source, folder, {HEADER: [ENUMERATOR], MODEL: []})
        ran, _ = changes.compiled(compiler, source, folder, [MODEL], "", "-Wall", "-fsyntax-only")
        return sum("equidistant" in line and "Wswitch" in line for line in ran.stderr.splitlines())


def reader_compiles(compiler, source):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        changes.changed_copies(source, folder, CHANGES)
        ran, _ = changes.compiled(compiler, source, folder, [READER], "", "-fsyntax-only")
        print(ran.stderr, end="")
        return ran.returncode == 0


def main():
    compiler, source = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    printed = changes.printed_lines(compiler, source, CHANGES, SOURCES, PROGRAM)
    print(*printed, sep="\n")
    named = warnings_without_cases(compiler, source)
    print(f"{named} of {SWITCHES} switches named; {len(CHANGES)} files changed")
    return 0 if printed == EXPECTED and named == SWITCHES and reader_compiles(compiler, source) else 1


if __name__ == "__main__":
    sys.exit(main())
