"""The generator of ROS messages' structs: faults in definitions, the order of declarations, its output as C++."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from e2e.support import ROOT

GENERATOR = ROOT / "src" / "ros" / "generator"
DEFINITIONS = ROOT / "src" / "ros" / "definitions"
# Members of every kind, with values that need care in C++.
EVERYTHING = """# Of everything something.

int64 LOWEST=-9223372036854775808
uint64 HIGHEST = 18446744073709551615  # 2^64 - 1
float32 THIRD=0.333
bool YES=true
byte MASK=255
char LETTER=200
string NAME="a # b"  # a name
# The time
# of the start.
builtin_interfaces/Time stamp
Part[<=2] parts
Part[2] pair
float64 scale 1e-3
bool[] flags [true, False]
bool[2] switches [1, 0]
uint8[] data [1, 2]
uint8[<=3] few [7]
uint8[4] id
byte level 2
char[2] letters [65, 200]
string<=5 word 'it"s'
string<=5[<=2] words ["a, b", 'c#d']  # two words
int64 low -9223372036854775808
"""
INCLUDED = ["ros/codec", "ros/messages/all_messages", "ros/messages/a_msgs_1"]
PROGRAM = """
using namespace gloam;
using a_msgs::Everything;
static_assert(Everything::LOWEST == INT64_MIN && Everything::HIGHEST == UINT64_MAX && Everything::THIRD == 0.333f && Everything::YES);
static_assert(Everything::MASK == std::byte{255} && Everything::LETTER == static_cast<char>(200) && Everything::NAME == "a # b");
static_assert(std::is_same_v<decltype(Everything::parts), BoundedVector<a_msgs::Part, 2>>);
static_assert(std::is_same_v<decltype(Everything::words), BoundedVector<BoundedString<5>, 2>>);
static_assert(std::is_same_v<decltype(a_msgs::srv::Find_Response::part), a_msgs::Part>);
static_assert(std::is_same_v<decltype(a_msgs_1::srv::Find_Response::part), a_msgs_1::Part>);
static_assert(std::is_same_v<decltype(a_msgs::action::Go_GetResult_Response::result), a_msgs::action::Go_Result>);
static_assert(Everything::kConstants[2].value == "0.333" && Everything::kDefaults[0].value == "1e-3");
int main() {
  const Everything all;
  const bool numbers = all.scale == 1e-3 && all.data.span()[1] == 2 && all.few.size() == 1 && all.level == std::byte{2} &&
                       all.id == std::array<uint8_t, 4>{} && all.letters[1] == static_cast<char>(200) && all.low == INT64_MIN;
  const bool others = all.flags == Bools{1, 0} && all.switches == std::array{true, false} && all.word == "it\\"s" &&
                      all.words[0] == "a, b" && all.words[1] == "c#d" && all.pair[1] == a_msgs::Part{};
  size_t count = 0;
  AllMessages::for_each([&]<class T>(std::type_identity<T>) { ++count; });
  return numbers && others && count == 14 && a_msgs_1::srv::kPackage == "a_msgs/srv" ? 0 : 1;
}
"""


class Definitions(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        self.addCleanup(folder.cleanup)
        self.definitions, self.out = Path(folder.name) / "definitions", Path(folder.name) / "out" / "ros" / "messages"

    def write(self, name, text):
        path = self.definitions / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def generate(self, definitions=None):
        return subprocess.run([sys.executable, "-B", str(GENERATOR / "generate_messages.py"), "--definitions",
                               str(definitions or self.definitions), "--out", str(self.out)], capture_output=True, text=True)

    def fails(self, text, line, message, name="a_msgs/msg/Bad.msg"):
        path = self.write(name, text)
        result = self.generate()
        place = f"{path}:{line}" if line else str(path)
        self.assertEqual((result.returncode, result.stdout), (1, ""), text)
        self.assertEqual(result.stderr.strip(), f"{place}: error: {message}")
        path.unlink()

    def test_types_that_do_not_exist(self):
        self.fails("int32 a\nfloat b\n", 2, "'float' is not a type: expected a primitive type, Name or package/Name")
        self.fails("Missing a\n", 1, "field 'a': there is no message a_msgs/Missing")
        self.fails("# text\n\nb_msgs/Missing a\n", 3, "field 'a': there is no message b_msgs/Missing")
        self.fails("b_msgs/srv/Find a\n", 1, "'b_msgs/srv/Find' is not a type: expected a primitive type, Name or package/Name")
        self.fails("wstring a\n", 1, "type wstring is not supported")
        self.fails("bool[<=3] a\n", 1, "bounded sequences of bool are not supported: use bool[] or bool[N]")
        self.fails("int32<=3 a\n", 1, "'int32<=3' is not a type: only strings have a bound")

    def test_names(self):
        self.fails("int32 a\nint32 b\nuint8 a\n", 3, "'a' is defined twice")
        self.fails("int32 A=1\nint32 A=1\n", 2, "'A' is defined twice")
        self.fails("int32 Angle\n", 1, "'Angle' is not the name of a field: expected lower-case letters, digits and underscores")
        self.fails("int32 a__b\n", 1, "'a__b' is not the name of a field: expected lower-case letters, digits and underscores")
        self.fails("int32 limit=1\n", 1, "'limit' is not the name of a constant: expected capital letters, digits and underscores")
        self.fails("int32 class\n", 1, "a field cannot be called 'class': C++ reserves the name")
        self.fails("int32 members\n", 1, "a field cannot be called 'members': C++ reserves the name")
        self.fails("int32\n", 1, "'int32' is neither a field nor a constant: expected a type and a name")

    def test_sizes(self):
        for size in ("0", "-1", "x", "1.5", "4294967296", "<=0", "<=", "<3"):
            self.fails(f"int32[{size}] a\n", 1, f"'{size.removeprefix('<=')}' is not a size: expected 1 to 4294967295")
        self.fails("string<=0 a\n", 1, "'0' is not a size: expected 1 to 4294967295")
        self.fails("int32[3 a\n", 1, "'int32[3' is not a type")
        self.fails("int32[2][3] a\n", 1, "'int32[2][3]' is not a type")

    def test_constants(self):
        self.fails("uint8 A=256\n", 1, "256 is out of range: uint8 has 0 to 255")
        self.fails("int8 A=-129\n", 1, "-129 is out of range: int8 has -128 to 127")
        self.fails("int32 A=1.5\n", 1, "'1.5' is not a value of type int32")
        self.fails("int32 A=\n", 1, "'' is not a value of type int32")
        self.fails("float32 A=1e39\n", 1, "1e39 is out of range of float32")
        self.fails("float64 A=nan\n", 1, "'nan' is not a value of type float64")
        self.fails("bool A=2\n", 1, "'2' is not a value of type bool")
        self.fails("string A='b\n", 1, "a quote is not closed: 'b")
        self.fails("string A='b' c\n", 1, "'b' c is not a string: the quotes must enclose all of it")
        self.fails('string A="\\n"\n', 1, '"\\n" has escapes, which are not supported')
        self.fails("int32[] A=[1]\n", 1, "constant 'A' has type int32[]: expected a primitive type without bounds")
        self.fails("a_msgs/B A=1\n", 1, "constant 'A' has type a_msgs/B: expected a primitive type without bounds")

    def test_defaults(self):
        self.fails("int32 a x\n", 1, "'x' is not a value of type int32")
        self.fails("int32[2] a [1, 2, 3]\n", 1, "[1, 2, 3] has 3 elements, its type [2]")
        self.fails("int32[<=2] a [1, 2, 3]\n", 1, "[1, 2, 3] has 3 elements, its type [<=2]")
        self.fails("int32[] a 1\n", 1, "1 is not a list such as [1, 2]")
        self.fails("string<=2 a abc\n", 1, "abc has more than 2 characters")
        self.write("a_msgs/msg/Good.msg", "int32 a\n")
        self.fails("Good a 1\n", 1, "a field of type Good cannot have a default value")

    def test_files_and_parts(self):
        self.fails("int32 a\n", 1, "a line '---' is missing: a .srv file has 2 parts", "a_msgs/srv/Bad.srv")
        self.fails("---\n---\n", 2, "too many lines '---': a .srv file has 2 parts", "a_msgs/srv/Bad.srv")
        self.fails("---\n\n", 2, "a line '---' is missing: a .action file has 3 parts", "a_msgs/action/Bad.action")
        self.fails("---\nint32 a\nint32 a\n", 3, "'a' is defined twice", "a_msgs/srv/Bad.srv")
        self.fails("", 0, "'bad' is not the name of an interface: expected CamelCase", "a_msgs/msg/bad.msg")
        expected = "expected PACKAGE/msg/Name.msg, PACKAGE/srv/Name.srv or PACKAGE/action/Name.action"
        self.fails("", 0, expected, "a_msgs/srv/Bad.msg")
        self.fails("", 0, expected, "a_msgs/msg/Bad.mgs")
        self.fails("", 0, "expected a folder PACKAGE or PACKAGE-VERSION", "README.md")
        path = self.write("a_msgs/msg/Bad.msg", "")
        path.write_bytes(b"int32 a # \xff\n")
        self.assertEqual(self.generate().stderr.strip(), f"{path}: error: the file is not UTF-8")

    def test_cycles(self):
        self.fails("int32 a\nBad[] b\n", 2, "the definitions form a cycle: a_msgs/Bad -> a_msgs/Bad")
        self.write("b_msgs/msg/B.msg", "a_msgs/Bad a\n")
        self.write("b_msgs/msg/C.msg", "")
        path = self.write("a_msgs/msg/Bad.msg", "b_msgs/C c\n")
        result = self.generate()
        self.assertIn("the definitions form a cycle: a_msgs -> b_msgs -> a_msgs", result.stderr)
        self.assertTrue(result.stderr.startswith(str(self.definitions)), result.stderr)
        path.unlink()

    def test_nothing_is_written_after_an_error(self):
        self.write("a_msgs/msg/Good.msg", "int32 a\n")
        self.fails("int a\n", 1, "'int' is not a type: expected a primitive type, Name or package/Name")
        self.assertFalse(self.out.exists())

    def test_only_headers_that_change_are_written(self):
        self.write("a_msgs/msg/A.msg", "int32 a\n")
        changed, removed = self.write("b_msgs/msg/B.msg", "int32 a\n"), self.write("c_msgs/msg/C.msg", "")
        self.assertEqual(self.generate().returncode, 0)
        for file in self.out.iterdir():
            os.utime(file, (1, 1))
        changed.write_text("int32 a\nint32 b\n")
        removed.unlink()
        removed.parent.rmdir()
        removed.parent.parent.rmdir()
        self.assertEqual(self.generate().returncode, 0)
        self.assertEqual({file.name: file.stat().st_mtime == 1 for file in self.out.iterdir()},
                         {"a_msgs.h": True, "b_msgs.h": False, "all_messages.h": False})

    def test_structs_have_the_types_values_and_versions_of_their_definitions(self):
        self.write("a_msgs/msg/Everything.msg", EVERYTHING)
        self.write("a_msgs/msg/Part.msg", "string text\n")
        self.write("a_msgs/srv/Find.srv", "string text\n---\nPart part\n")
        self.write("a_msgs/action/Go.action", "---\na_msgs/Part part\n---\n")
        self.write("a_msgs-1/msg/Part.msg", "int32 number\n")
        self.write("a_msgs-1/srv/Find.srv", "string text\n---\nPart part\nEverything all\n")
        self.write("builtin_interfaces/msg/Time.msg", "int32 sec\nuint32 nanosec\n")
        self.fails("---\n---\n", 1, "field 'goal_id': there is no message unique_identifier_msgs/UUID", "a_msgs/action/Go.action")
        self.write("a_msgs/action/Go.action", "---\na_msgs/Part part\n---\n")
        self.write("unique_identifier_msgs/msg/UUID.msg", "uint8[16] uuid\n")
        result = self.generate()
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        header = (self.out / "a_msgs.h").read_text()
        self.assertIn("/// Of everything something.\nstruct Everything {\n", header)
        self.assertIn("  static constexpr uint64_t HIGHEST = 18446744073709551615ull;  ///< 2^64 - 1\n", header)
        self.assertIn("  /// The time\n  /// of the start.\n  builtin_interfaces::Time stamp;\n", header)
        self.compile_and_run("".join(f'#include "{name}.h"\n' for name in INCLUDED) + PROGRAM)

    def compile_and_run(self, text):
        source, program = self.out.parent / "program.cc", self.out.parent / "program"
        source.write_text(text)
        result = subprocess.run(["c++", "-std=c++20", "-Wall", "-Wextra", "-Werror", f"-I{ROOT / 'src'}", f"-I{ROOT / 'include'}",
                                 f"-I{self.out.parents[1]}", str(source), "-o", str(program)], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr[:4000])
        self.assertEqual(subprocess.run([str(program)]).returncode, 0)

    def test_the_definitions_of_gloam_are_good(self):
        result = self.generate(DEFINITIONS)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertGreater(len(list(self.out.iterdir())), 20)


if __name__ == "__main__":
    unittest.main()
