"""Each check of this folder finds what it is for, and only that: self_test.py"""
import sys
import tempfile
import unittest
from pathlib import Path

import function_length
import header_openings
import internal_includes
import layers
import named_tests
import thresholds
import words
from cpp_source import declarations

# A repository in which all is well: area headers with nothing but what they need.
AREA_HEADERS = {
    f"include/surefoot/{area}.hpp": f"// Headers of {area}.\n" + "".join(
        f'#include "surefoot/{used}.hpp"\n' for used in layers.MAY[area])
    for area in layers.MAY if area not in layers.OPTIONAL
}
AREA_HEADERS["include/surefoot/version.hpp"] = "// Version of surefoot.\n"
AREA_HEADERS["include/surefoot/surefoot.hpp"] = "// Headers of all areas.\n" + "".join(
    f'#include "surefoot/{area}.hpp"\n' for area in [*(a for a in layers.MAY if a not in layers.OPTIONAL), "version"])


class Checks(unittest.TestCase):
    def faults(self, check, files):
        """What `check` says of a repository of these files."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**AREA_HEADERS, **files}.items():
                path = Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return check(folder)

    def expect(self, check, files, *wanted):
        """`check` says one thing for each of `wanted`, which holds its place and words of its reason."""
        found = self.faults(check, files)
        self.assertEqual(len(found), len(wanted), found)
        for fault, (place, reason) in zip(found, wanted):
            self.assertTrue(fault.startswith(place), fault)
            self.assertIn(reason, fault)

    def test_layers(self):
        room = "include/surefoot/diagnose/verdict/a.hpp"
        self.expect(layers.check, {})
        self.expect(layers.check, {room: "// A.\n#include <vector>\n#include <Eigen/Core>\n"})
        self.expect(layers.check, {room: "// A.\n#include <boost/any.hpp>\n"}, (f"{room}:2", "neither Eigen"))
        self.expect(layers.check, {room: '// A.\n#include "a.hpp"\n'}, (f"{room}:2", "not a header of an area"))

    def test_layers_of_areas_and_rooms(self):
        below = "include/surefoot/diagnose/estimation/a.hpp"
        above = "include/surefoot/diagnose/verdict/b.hpp"
        include_above = {below: '// A.\n#include "surefoot/diagnose/verdict/b.hpp"\n', above: "// B.\n"}
        include_below = {below: "// A.\n", above: '// B.\n#include "surefoot/diagnose/estimation/a.hpp"\n'}
        self.expect(layers.check, include_above, (f"{below}:2", "verdict lies above estimation"))
        self.expect(layers.check, include_below)
        tests = "include/surefoot/diagnose/residual_tests/a.hpp"
        beside = {tests: '// A.\n#include "surefoot/diagnose/selection/b.hpp"\n',
                  "include/surefoot/diagnose/selection/b.hpp": "// B.\n"}
        self.expect(layers.check, beside, (f"{tests}:2", "selection lies beside residual_tests"))
        other = "include/surefoot/diagnose/verdict/a.hpp"
        self.expect(layers.check, {other: '// A.\n#include "surefoot/motion/fit/b.hpp"\n',
                                   "include/surefoot/motion/fit/b.hpp": "// B.\n"},
                    (f"{other}:2", "diagnose may not include motion"))
        self.expect(layers.check, {other: '// A.\n#include "surefoot/forest/train/b.hpp"\n',
                                   "include/surefoot/forest/train/b.hpp": "// B.\n"},
                    (f"{other}:2", "a room of forest"))
        self.expect(layers.check, {"include/surefoot/forest/cellar/a.hpp": "// A.\n"},
                    ("include/surefoot/forest/cellar/a.hpp:1", "no room cellar"))

    def test_layers_find_circles_through_definitions(self):
        room = "surefoot/forest/train"
        ending = f'\n#ifndef SUREFOOT_COMPILED\n#include "{room}/a.ipp"\n#endif\n'
        files = {f"include/{room}/a.hpp": "// A.\n" + ending,
                 f"include/{room}/a.ipp": f'// Definitions.\n#include "{room}/a.hpp"\n',
                 f"include/{room}/b.hpp": f'// B.\n#include "{room}/a.hpp"\n'}
        self.expect(layers.check, files)
        files[f"include/{room}/a.ipp"] += f'#include "{room}/b.hpp"\n'
        self.expect(layers.check, files, ("include one another in a circle", f"{room}/a, {room}/b"))
        files[f"include/{room}/a.ipp"] = "// Definitions.\n"
        self.expect(layers.check, files, (f"include/{room}/a.ipp:1", "does not include its own header"))
        files = {f"include/{room}/a.hpp": f'// A.\n#include "{room}/a.ipp"\n',
                 f"include/{room}/a.ipp": f'// Definitions.\n#include "{room}/a.hpp"\n'}
        self.expect(layers.check, files, (f"include/{room}/a.hpp:2", "must end with these three lines"))

    def test_layers_of_area_headers(self):
        face = {"include/surefoot/forest/a.hpp": "// A.\n"}
        self.expect(layers.check, face, ("include/surefoot/forest.hpp:1", "does not include surefoot/forest/a.hpp"))
        face["include/surefoot/forest.hpp"] = AREA_HEADERS["include/surefoot/forest.hpp"] + \
            '#include "surefoot/forest/a.hpp"\n#include "surefoot/motion.hpp"\n'
        self.expect(layers.check, face, ("include/surefoot/forest.hpp:1", "may not include surefoot/motion.hpp"))

    def test_internal_includes(self):
        library = {"include/surefoot/motion/fit/a.hpp": "// A.\nnamespace surefoot::detail {\nstruct Hidden {};\n}\n"}

        def program(text, *wanted, place="apps/p.cpp"):
            self.expect(internal_includes.check, {**library, place: text}, *wanted)

        program('#include "surefoot/motion/calibrate.hpp"\n#include "surefoot/diagnose/effects/effect.hpp"\n')
        program('#include "surefoot/motion/fit/a.hpp"\n', ("apps/p.cpp:1", "internal"))
        program('#include "surefoot/motion/a.ipp"\n', ("apps/p.cpp:1", "internal"))
        program("int x;\nsurefoot::detail::Hidden hidden;\n", ("apps/p.cpp:2", "names surefoot::detail::Hidden"))
        program("using namespace surefoot::diagnosis;\n", ("apps/p.cpp:1", "internal"))
        program("using namespace surefoot;\ndetail::Hidden hidden;\n", ("apps/p.cpp:2", "internal"))
        program("namespace detail { struct Own {}; }\ndetail::Own own;  // surefoot::detail::Hidden\n")
        program("surefoot::diagnosis::x();\n", place="benchmarks/blind/all_at_once/p.cpp")

    def test_function_length(self):
        def lines(count):
            return "\n".join(["  ++x;"] * count)
        header = "include/surefoot/core/a.hpp"
        self.expect(function_length.check, {header: f"int f(int x) {{\n{lines(77)}\n  return x;\n}}\n"})
        self.expect(function_length.check, {header: f"int f(int x) {{\n{lines(78)}\n  return x;\n}}\n"},
                    (f"{header}:1", "f has 81 lines"))
        self.expect(function_length.check,
                    {header: f"struct A {{\n  A() : a_{{1}}, b_(2) {{\n{lines(80)}\n  }}\n  int a_, b_;\n}};\n"},
                    (f"{header}:2", "A has 82 lines"))
        self.expect(function_length.check,
                    {header: f"template <class T>\nauto f(T x) {{\n  const auto g = [&] {{\n{lines(80)}\n  }};\n}}\n"},
                    (f"{header}:1", "f has 85 lines"))
        self.expect(function_length.check, {header: f"inline constexpr auto f = [](int x) {{\n{lines(80)}\n}};\n"},
                    (f"{header}:1", "f has 82 lines"))

    def test_words_in_names(self):
        header = "include/surefoot/diagnose/a.hpp"

        def names(code, *wanted):
            text = f"// A.\nnamespace surefoot {{\n{code}\n}}\n"
            self.expect(words.check, {header: text}, *wanted)

        names("struct SimulatorRig {};", (f"{header}:3", "SimulatorRig says 'rig'"))
        names("struct A {\n  double right = 1;\n  int facts = 2;\n};", (f"{header}:5", "A::facts"))
        names("enum class Verdict { clean, unexplained };")
        names("struct A {\n  double unexplained;\n};", (f"{header}:4", "A::unexplained"))
        names("void make(int veto);", (f"{header}:3", "'veto'"))
        names("double held_out_rms(int held_out);")
        names("bool held(int i);", (f"{header}:3", "'held'"))
        names("class A {\n  int rig_;\n\n public:\n  int rig() const;\n};", (f"{header}:7", "A::rig"))
        names("namespace detail {\nstruct Rig {};\n}")
        self.expect(words.check, {"include/surefoot/diagnose/verdict/a.hpp":
                                  "// A.\nnamespace surefoot::diagnosis {\nstruct Rig {};\n}\n"})
        self.expect(words.check, {"apps/calibrate/p.cpp": 'add("--facts");\n'}, ("apps/calibrate/p.cpp:1", "--facts"))

    def test_words_in_text(self):
        self.expect(words.check, {"apps/p.cpp": '\nauto s = "recordings kept aside";\n'}, ("apps/p.cpp:2", "kept aside"))
        self.expect(words.check, {"docs/a.md": "The concealed proof, by `concealed_score`.\n"}, ("docs/a.md:1", "concealed"))
        self.expect(words.check, {"examples/p.cpp": "// a moment later\nint investigation = 0;\n"})

    def test_header_openings(self):
        def opening(line, *wanted):
            self.expect(header_openings.check, {"include/surefoot/core/a.hpp": line + "\n#pragma once\n"}, *wanted)
        place = "include/surefoot/core/a.hpp:1"
        opening("// Options of `diagnose()`.")
        opening("// Plans of experiments.")
        opening("// What one can set.", (place, "'what'"))
        opening("// Runs a problem.", (place, "verb 'runs'"))
        opening("// Sets the options.", (place, "verb 'sets'"))
        opening("#pragma once", (place, "does not open with a comment"))

    def test_thresholds(self):
        header = "include/surefoot/diagnose/verdict/a.hpp"

        def code(text, *wanted):
            self.expect(thresholds.check, {header: "// A.\n\n" + text}, *wanted)

        code("bool f(double x) { return x > 0 && 0.5 * x < 2; }\n")
        code("double f(double x) { return x / (x + 1e-300); }\n")
        code("void f() {\n  double sums[3] = {};\n  Vec<3> v;\n}\n")
        code("bool f(double x) {\n  return x > 0.97;\n}\n", (f"{header}:4", "0.97 without a name, in f()"))
        code("bool f(double x) {\n  return x > 0.5;\n}\n", (f"{header}:4", "0.5 without a name"))
        code("bool f(double x, double least = 0.1);\n", (f"{header}:3", "0.1 without a name"))
        code("struct A {\n  double least = 0.1;\n};\n", (f"{header}:4", "0.1 without a reason"))
        code("struct A {\n  double least = 0.1;  // of the error: less is noise\n};\n")
        code("// Less is noise.\nconstexpr double least = 0.1;\n")
        code("void f() {\n  constexpr int most = 3;\n}\n", (f"{header}:4", "3 without a reason"))
        code("void f() {\n  constexpr int most = 3;  // more cannot be told apart\n}\n")
        self.expect(thresholds.check, {"include/surefoot/diagnose/estimation/a.hpp": "// A.\nint f() { return 7; }\n"})

    def test_named_tests(self):
        header = "include/surefoot/diagnose/verdict/a.hpp"
        self.expect(named_tests.check, {header: "// A.\n"}, (f"{header}:1", "no tests/diagnose/verdict/a_test.cpp"))
        self.expect(named_tests.check, {header: "// A.\n", "tests/diagnose/verdict/a_test.cpp": "// Tests.\n"})
        self.expect(named_tests.check, {"include/surefoot/forest/train/a.hpp": "// A.\n"})
        self.expect(named_tests.check, {"include/surefoot/forest/a.hpp": "// A.\n"},
                    ("include/surefoot/forest/a.hpp:1", "no tests/forest/a_test.cpp"))

    def test_declarations(self):
        found = [(d.kind, d.name, d.first_line, d.last_line) for d in declarations("""
template <class T, int N = (1 < 2)>
  requires requires(T t) { t.x; }
struct A : B<T> {
  explicit A(int a) noexcept : a_{a} {}
  bool operator==(const A&) const = default;
  bool operator()(int i) const { return i; }
  std::function<void(int)> call = [](int) {};
  double x = 1, y[2] = {1, 2};
  enum class Kind : int { one = 1, two };
};
template <class T>
concept C = requires(T t) {
  { t.f() } -> std::same_as<int>;
};
using Name = int;
inline auto f(A a = {}, int b = 2) -> int {
  return b;
}
""")]
        self.assertEqual(found, [
            ("type", "A", 2, 11), ("function", "A", 5, 5), ("function", "operator==", 6, 6),
            ("function", "operator()", 7, 7), ("variable", "call", 8, 8), ("variable", "x", 9, 9),
            ("variable", "y", 9, 9), ("type", "Kind", 10, 10), ("enumerator", "one", 10, 10),
            ("enumerator", "two", 10, 10), ("concept", "C", 12, 15), ("alias", "Name", 16, 16),
            ("function", "f", 17, 19)])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-q"])
