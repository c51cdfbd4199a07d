"""What the operators make of a few lines, and which lines are statements."""
import pathlib
import tempfile
import unittest

import mutations


def lines_of(text):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "kernels").mkdir()
        (root / "kernels/a.cpp").write_text(text)
        return mutations.statement_lines(root)


def mutated(statement, operator):
    line = lines_of("int f() {\n  int x = 0;\n  " + statement + "\n}\n")[1]
    return {m.after for m in mutations.mutations_of(line) if m.operator == operator}


class StatementLines(unittest.TestCase):
    def test_are_those_inside_of_functions(self):
        text = """#include "a.hpp"
namespace glint {
constexpr int k = 3;  // no statement
struct S : T {
  int member = 1;
  explicit S(int a) : member(a) {
    use(a);
  }
  int get() const { return member; }
};
constexpr std::array<int, 2> table{1, 2};
template <class T>
T twice(T x) noexcept {
  /* if (x) */
  static_assert(k > std::max({1,
                              2}));
  const char* s = "x + y";
  return 2 * x;
}
}
"""
        self.assertEqual([line.number for line in lines_of(text)], [7, 9, 17, 18])


class Operators(unittest.TestCase):
    def test_boundary(self):
        self.assertEqual(mutated("if (x < 3) g<4>(x);", "boundary"), {"if (x <= 3) g<4>(x);"})

    def test_condition(self):
        self.assertEqual(mutated("if (x == y) {", "condition"), {"if (!(x == y)) {"})
        self.assertEqual(mutated("if (const auto y = f()) {", "condition"), set())
        self.assertEqual(mutated("for (; x < 3; ++x) {", "condition"), {"for (; false; ++x) {"})

    def test_arithmetic(self):
        self.assertEqual(mutated("x += -y;", "arithmetic"), {"x -= -y;", "x += y;"})

    def test_constant(self):
        self.assertEqual(mutated("x = 7u;", "constant"), {"x = 6u;", "x = 8u;"})
        self.assertEqual(mutated("x = 0.5f * y2;", "constant"), {"x = 1.5f * y2;"})

    def test_deleted(self):
        self.assertEqual(mutated("x = y;", "deleted"), {";"})
        self.assertEqual(mutated("if (x) continue;", "deleted"), {";"})
        for kept in ("const int y = 3;", "Pose pose;", "std::array<int, 3> a{};", "return x;"):
            self.assertEqual(mutated(kept, "deleted"), set(), kept)

    def test_returned(self):
        self.assertEqual(mutated("return x;", "returned"), {"return {};"})
        self.assertEqual(mutated("return false;", "constant"), {"return true;"})

    def test_arguments(self):
        self.assertEqual(mutated("g(a, h(b, c));", "arguments"),
                         {"g(h(b, c), a);", "g(a, h(c, b));"})
        self.assertEqual(mutated("x = std::min(a, b);", "arguments"), set())

    def test_text_is_left_alone(self):
        self.assertEqual(mutated('g("1 + 2");  // 3 < 4', "arithmetic"), set())

    def test_a_sample_changes_only_where_the_code_does(self):
        lines = [f"  x{i} = y{i} + {i};" for i in range(3, 40)]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "kernels" / "a.cpp"
            file.parent.mkdir()

            def sample():
                file.write_text("\n".join(["void f() {", *lines, "}", ""]))
                return [(m.before, m.after) for m in mutations.drawn(pathlib.Path(folder), 1)]

            first = sample()
            self.assertEqual(len(first), len(lines))
            self.assertNotEqual(first, sorted(first))
            lines.insert(10, "  z = 2 * y3;")
            self.assertEqual([pair for pair in sample() if pair[0] != "z = 2 * y3;"], first)


if __name__ == "__main__":
    unittest.main()
