// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "run/text/text_lines.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_text_source {

using isobar::test::TemporaryFolder;
using isobar::text::TextLines;

namespace {

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

void write_gzip(const std::filesystem::path& file, const std::string& bytes) {
  gzFile_s* out = gzopen(file.c_str(), "wb");
  REQUIRE(gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size())) == static_cast<int>(bytes.size()));
  REQUIRE(gzclose(out) == Z_OK);
}

/// Text of code points below 0x10000 in UTF-16.
std::string utf16(const std::u16string& text, bool big_endian, bool mark = true) {
  std::string bytes;
  for (const char16_t unit : (mark ? u"\uFEFF" : u"") + text) {
    const char low = static_cast<char>(unit & 0xFFU);
    const char high = static_cast<char>(unit >> 8U);
    bytes += big_endian ? high : low;
    bytes += big_endian ? low : high;
  }
  return bytes;
}

std::vector<std::string> lines_of(TextLines& lines) {
  std::vector<std::string> all;
  std::string_view line;
  while (lines.next(line)) all.emplace_back(line);
  return all;
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  TextLines lines(file);
  return lines_of(lines);
}

std::string many_rows(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += "row " + std::to_string(i) + "\n";
  return text;
}

}  // namespace

TEST_CASE("UTF-16 without a byte-order mark is told by the zeros of its Latin letters") {
  const TemporaryFolder scratch;
  for (const bool big_endian : {false, true}) {
    const std::filesystem::path file = scratch.path() / "log.csv";
    write(file, utf16(u"Zeit;Temp \u00B0C\n1;2\n", big_endian, false));
    CHECK(lines_of(file) == std::vector<std::string>{"Zeit;Temp \xC2\xB0"
                                                     "C",
                                                     "1;2"});
  }
}

TEST_CASE("files in UTF-16 of either byte order read as UTF-8, surrogate pairs and broken halves included") {
  const TemporaryFolder folder;
  const std::vector<std::string> expected{
      "T (\xC2\xB0"
      "C);\xE2\x82\xAC",
      "\xF0\x9F\x98\x80", "\xEF\xBF\xBD."};
  for (const bool big_endian : {false, true}) {
    CAPTURE(big_endian);
    std::string bytes = utf16(u"T (\u00B0C);\u20AC\r\n\U0001F600\r\n", big_endian);
    bytes += big_endian ? std::string("\xD8\x00\x00.", 4) : std::string("\x00\xD8.\x00", 4);
    write(folder.path() / "u.csv", bytes);
    CHECK(lines_of(folder.path() / "u.csv") == expected);
  }
}

TEST_CASE("a long file in UTF-16 loses nothing where its pieces are read") {
  const TemporaryFolder folder;
  const std::string rows = many_rows(20'000);
  write(folder.path() / "u.csv", utf16(std::u16string(rows.begin(), rows.end()), false));
  write(folder.path() / "a.csv", rows);
  CHECK(lines_of(folder.path() / "u.csv") == lines_of(folder.path() / "a.csv"));
}

TEST_CASE("a file compressed with gzip reads as its text, also from near its end") {
  const TemporaryFolder folder;
  const std::string rows = many_rows(20'000);
  write(folder.path() / "plain", rows);
  write_gzip(folder.path() / "packed", rows);
  CHECK(lines_of(folder.path() / "packed") == lines_of(folder.path() / "plain"));
  for (const char* name : {"plain", "packed"}) {
    CAPTURE(name);
    TextLines lines(folder.path() / name);
    std::string_view line;
    REQUIRE(lines.next(line));
    CHECK(line == "row 0");
    lines.skip_to_last(100);
    const std::vector<std::string> last = lines_of(lines);
    CHECK(last.size() == 9);  // "row 19999\n" is ten bytes; the first one is not whole
    CHECK(last.back() == "row 19999");
    CHECK(lines.damage().empty());
  }
}

TEST_CASE("a compressed file that was cut gives what it holds and says that it is damaged") {
  const TemporaryFolder folder;
  write_gzip(folder.path() / "whole", many_rows(20'000));
  const auto size = std::filesystem::file_size(folder.path() / "whole");
  std::filesystem::resize_file(folder.path() / "whole", size / 2);
  TextLines lines(folder.path() / "whole");
  CHECK(lines_of(lines).size() > 1'000);
  CHECK(lines.damage().find("the compressed file is damaged: unexpected end of file") != std::string::npos);
}

}  // namespace isobar::test::test_text_source
