// SPDX-License-Identifier: BSD-3-Clause
#include "config/end_mark.hpp"

#include "config/checksum.hpp"
#include "core/printable_text.hpp"

namespace isobar {
namespace {

constexpr std::string_view kSum = " sha256=";

/// First line of `text` from `begin` on, without its line end.
std::string_view line_at(std::string_view text, std::size_t begin) {
  std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// Whether a line among the comments at the top announces the end mark. A cut announcement counts: a file cut
/// there is not whole either.
bool announces(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte-order mark
  while (!text.empty()) {
    const std::string_view line = line_at(text, 0);
    const bool is_last = text.find('\n') == std::string_view::npos;
    if (line == kEndMarkAnnouncement) return true;
    if (is_last && line.size() > 2 && kEndMarkAnnouncement.starts_with(line)) return true;
    if (is_last || (!line.empty() && !line.starts_with('#'))) return false;
    text.remove_prefix(text.find('\n') + 1);
  }
  return false;
}

bool is_end_mark(std::string_view line) {
  return line == kEndMark || line.starts_with(std::string(kEndMark) + std::string(kSum));
}

/// Place of the last end mark; npos: none.
std::size_t find_end_mark(std::string_view text) {
  std::size_t at = text.rfind(kEndMark);
  while (at != std::string_view::npos) {
    const bool begins_line = at == 0 || text[at - 1] == '\n';
    if (begins_line && is_end_mark(line_at(text, at))) return at;
    at = at == 0 ? std::string_view::npos : text.rfind(kEndMark, at - 1);
  }
  return std::string_view::npos;
}

std::string broken_checksum(std::string_view text, std::size_t mark) {
  const std::string_view line = line_at(text, mark);
  const std::string_view told = line.substr(kEndMark.size() + kSum.size());
  const std::string sum = sha256_hex(text.substr(0, mark));
  if (told != sum) {
    return "the checksum of the last line is not that of the lines above it (" + printable(told, 12) +
           " instead of " + sum.substr(0, 12) +
           "…): the file was cut or changed; `isobar config seal FILE` prints it with a new one";
  }
  if (mark + line.size() + 2 < text.size()) {
    return "text follows after the checksum, which does not cover it; `isobar config seal FILE` prints the "
           "file with a new one";
  }
  return {};
}

}  // namespace

std::string with_end_mark(std::string_view text) {
  std::string result = std::string(kEndMarkAnnouncement) + "\n" + std::string(text);
  if (!result.ends_with('\n')) result += '\n';
  return result + std::string(kEndMark) + "\n";
}

std::string with_checksum(std::string_view text) {
  const std::size_t mark = find_end_mark(text);
  std::string body(text.substr(0, mark));
  if (mark != std::string_view::npos) {
    const std::size_t after = text.find('\n', mark);
    if (after != std::string_view::npos) body += text.substr(after + 1);
  }
  if (!body.empty() && !body.ends_with('\n')) body += '\n';
  if (!announces(body)) body = std::string(kEndMarkAnnouncement) + "\n" + body;
  return body + std::string(kEndMark) + std::string(kSum) + sha256_hex(body) + "\n";
}

std::string broken_end_mark(std::string_view text) {
  const std::size_t mark = find_end_mark(text);
  if (mark == std::string_view::npos) {
    return announces(text) ? "the file is cut: its top announces the last line \"" + std::string(kEndMark) +
                                 "\", which is missing; write the file again as a whole"
                           : "";
  }
  return line_at(text, mark) == kEndMark ? "" : broken_checksum(text, mark);
}

}  // namespace isobar
