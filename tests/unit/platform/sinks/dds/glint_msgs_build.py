"""The ROS 2 package glint_msgs builds by plain CMake with Debian's ament_cmake and rosidl generators.

Debian 12 has neither the message packages that glint_msgs depends on nor rosidl_default_generators:
small packages of the same names stand in for them. A C++ program then uses each generated type.

    glint_msgs_build.py SOURCE_FOLDER
Exit 0: built, and the program's checks hold; 1: something failed; 77: skipped, with a line.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

# The fields of the packages' own files, as far as glint_msgs uses them.
MESSAGES = {
    "builtin_interfaces": {"Time": "int32 sec\nuint32 nanosec\n"},
    "std_msgs": {"Header": "builtin_interfaces/Time stamp\nstring frame_id\n"},
    "geometry_msgs": {
        "Point": "float64 x\nfloat64 y\nfloat64 z\n",
        "Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
        "Quaternion": "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n",
        "Pose": "Point position\nQuaternion orientation\n",
        "PoseWithCovariance": "Pose pose\nfloat64[36] covariance\n",
        "PoseWithCovarianceStamped": "std_msgs/Header header\nPoseWithCovariance pose\n",
    },
}
GENERATORS = ("rosidl_adapter", "rosidl_cmake", "rosidl_generator_c", "rosidl_generator_cpp")


def package_xml(name, depends):
    lines = "".join(f"  <depend>{one}</depend>\n" for one in depends)
    return (f'<?xml version="1.0"?>\n<package format="3">\n  <name>{name}</name>\n'
            "  <version>0.0.1</version>\n  <description>Stands in for a package.</description>\n"
            '  <maintainer email="glint@example.org">Glint</maintainer>\n'
            f"  <license>Apache-2.0</license>\n{lines}"
            "  <member_of_group>rosidl_interface_packages</member_of_group>\n</package>\n")


def write_messages(folder, name, messages):
    depends = sorted({used for text in messages.values()
                      for used in re.findall(r"^(\w+)/", text, re.M)})
    (folder / "msg").mkdir(parents=True)
    for message, text in messages.items():
        (folder / "msg" / f"{message}.msg").write_text(text)
    (folder / "package.xml").write_text(package_xml(name, depends))
    find = "".join(f"find_package({one} REQUIRED)\n" for one in depends)
    files = " ".join(f"msg/{message}.msg" for message in messages)
    needs = f" DEPENDENCIES {' '.join(depends)}" if depends else ""
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.8)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n"
        f"find_package(rosidl_default_generators REQUIRED)\n{find}"
        f"rosidl_generate_interfaces({name} {files}{needs})\nament_package()\n")


def write_default_packages(prefix):
    for name in ("rosidl_default_generators", "rosidl_default_runtime"):
        folder = prefix / "share" / name / "cmake"
        folder.mkdir(parents=True)
        found = GENERATORS if name.endswith("generators") else ()
        (folder / f"{name}Config.cmake").write_text(
            "".join(f"find_package({one} REQUIRED)\n" for one in found))


def build(source, work, prefix):
    environment = dict(os.environ, AMENT_PREFIX_PATH=str(prefix))
    for command in (["cmake", "-S", source, "-B", work, "-G", "Unix Makefiles",
                     f"-DCMAKE_INSTALL_PREFIX={prefix}", f"-DCMAKE_PREFIX_PATH={prefix}",
                     "-DPython3_EXECUTABLE=/usr/bin/python3", "-DCMAKE_BUILD_TYPE=None",
                     "-DBUILD_TESTING=OFF"],
                    ["cmake", "--build", work, "-j", "2"],
                    ["cmake", "--install", work]):
        ran = subprocess.run(command, capture_output=True, text=True, env=environment)
        if ran.returncode != 0:
            print(ran.stdout[-3000:], ran.stderr[-3000:], sep="\n")
            print(f"{source.name}: {' '.join(map(str, command[:2]))} failed")
            sys.exit(1)
    print(f"{source.name}: built")


def header_of(message):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", message).lower()


def use_types(names, work, prefix):
    """Compiles and runs a program that has a value of each type, and checks some fields."""
    includes = "".join(f"#include <glint_msgs/msg/{header_of(name)}.hpp>\n" for name in names)
    values = "".join(f"  glint_msgs::msg::{name} v{i}; (void)v{i};\n" for i, name in enumerate(names))
    program = work / "use.cpp"
    program.write_text(f"""{includes}
int main() {{
{values}  glint_msgs::msg::Regions regions;
  regions.blobs.resize(2);
  regions.blobs[1].box.width = 7;
  regions.blobs[1].marker = "pen/2";
  glint_msgs::msg::Explanation explanation;
  explanation.text = "Tracked";
  return regions.header.frame_id.empty() && explanation.text.size() == 7 ? 0 : 1;
}}
""")
    folders = [f"-I{path}" for path in (prefix / "include").iterdir()] + [f"-I{prefix / 'include'}"]
    system = [f"-I{path}" for path in pathlib.Path("/usr/include").glob("rosidl_*")]
    subprocess.run(["c++", "-std=c++17", *folders, *system, program, "-o", work / "use"], check=True)
    return subprocess.run([work / "use"]).returncode


def main():
    package = pathlib.Path(sys.argv[1]) / "platform/sinks/dds/glint_msgs"
    if not pathlib.Path("/usr/share/rosidl_generator_cpp/cmake").exists() or \
            not pathlib.Path("/usr/share/ament_cmake/cmake").exists():
        print("skipped: ament-cmake and rosidl-generator-c-cpp are not installed")
        return 77
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        prefix = work / "installed"
        write_default_packages(prefix)
        for stand_in, messages in MESSAGES.items():
            write_messages(work / stand_in, stand_in, messages)
            build(work / stand_in, work / f"{stand_in}_build", prefix)
        build(package, work / "glint_msgs_build", prefix)
        names = sorted(path.stem for path in (package / "msg").glob("*.msg"))
        code = use_types(names, work, prefix)
        print(f"a program with a value of each of {len(names)} types ends with {code}; expected 0")
        return 0 if code == 0 else 1


sys.exit(main())
