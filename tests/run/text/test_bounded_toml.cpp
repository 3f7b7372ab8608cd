// SPDX-License-Identifier: BSD-3-Clause
// Bounds of a TOML text before it is parsed.
#include "run/text/bounded_toml.hpp"

#include <doctest/doctest.h>

#include <string>

#include "core/printable_text.hpp"

namespace isobar::test::test_bounded_toml {

namespace {

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

/// "LINE:COLUMN: rule" of the refusal; empty: parsed.
std::string refusal(const std::string& text) {
  try {
    (void)text::parse_bounded_toml(text, "t");
    return {};
  } catch (const text::TomlError& error) {
    return error.at("t").substr(2);
  }
}

bool refused(const std::string& text, const std::string& words) {
  CAPTURE(refusal(text));
  return refusal(text).find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("a text of any depth is refused before the parser's recursion overflows the stack") {
  const std::string parts = repeated("a.", 30'777) + "a";
  CHECK(refused(parts + " = 1\n", "1:32: a key has more than 16 parts"));
  CHECK(refused("[" + parts + "]\n", "more than 16 parts"));
  CHECK(refused("[[" + parts + "]]\n", "more than 16 parts"));
  CHECK(refused("x = {" + parts + " = 1}\n", "more than 16 parts"));
  CHECK(refused(repeated("\"a.b\" . ", 1000) + "a = 1\n", "more than 16 parts"));
  CHECK(refused("x = " + repeated("[", 40'000), "nested more than 16 deep"));
  CHECK(refused("x = " + repeated("{a = ", 40'000), "nested more than 16 deep"));
  CHECK(refused("x = " + repeated("[{a = ", 40'000), "nested more than 16 deep"));
}

TEST_CASE("no string hides a deep key from the bounds") {
  const std::string deep = repeated("a.", 2'000) + "a = 1";
  for (const char* string : {R"("")", R"("\"")", R"("\\")", "''", R"('\')", R"("""b""")", R"("""b"""")",
                             R"("""b""""")", R"("""b\"""")", "'''b'''", "'''b''''", "'''b'''''",
                             "\"\"\"\nb\\\n \"\"\"", "\"# no comment\"", "'\"'"}) {
    CAPTURE(string);
    CHECK(refusal("x = {a = " + std::string(string) + "}\n") == "");  // the parser knows the string
    CHECK(refused("x = {c = " + std::string(string) + ", " + deep + "}\n", "more than 16 parts"));
  }
}

TEST_CASE("what people write stays valid: dots in texts, comments and numbers, lists of lists") {
  CHECK(refusal("# " + repeated("a.", 100) + "\nx = \"" + repeated("a.", 100) + "\"\n") == "");
  CHECK(refusal("x = [" + repeated("[1.5, 2.5], ", 100) + "]\n") == "");
  CHECK(refusal("a.b.c.d.e.f.g = 1.5 # x.y\n\"p.q\".r = '''\n[[[[[[[[[[[[[[[[[[[[[[\n'''\n") == "");
  CHECK(refusal("\xEF\xBB\xBF"
                "a = 1\r\nb = 2\r\n") == "");
}

TEST_CASE("bytes that are no text are refused with their place") {
  CHECK(refused(std::string("a = 1\nb\0 = 2\n", 13), "2:2: holds a NUL byte"));
  CHECK(refused("a = \"\xFF\"\n", "1:6: is no UTF-8 text"));
  CHECK(refused("# \xC0\xAF\n", "1:3: is no UTF-8 text"));
  CHECK(refused("a = 1\x1B[2J\n", "1:6: holds the control character \\x1B"));
  CHECK(refused("a = 1 # \x0B b = 2\n", "control character \\x0B"));
  CHECK(refused("a = 1\rb = 2\n", "control character \\x0D"));
}

TEST_CASE("errors about foreign text are short and hold no control characters") {
  const std::string message =
      refusal("[" + std::string(20'000, 'k') + "]\n[" + std::string(20'000, 'k') + "]\n");
  CHECK(!message.empty());
  CHECK(message.size() < 300);
  CHECK(printable("a\n\x1B\xFF"
                  "é\xC2\x9B") == "a\\x0A\\x1B\\xFFé\\xC2\\x9B");
  CHECK(printable(std::string(500, 'x'), 5) == "xxxxx…");
}

}  // namespace isobar::test::test_bounded_toml
