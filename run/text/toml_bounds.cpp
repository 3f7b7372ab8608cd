// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/toml_bounds.hpp"

#include "core/printable_text.hpp"

namespace isobar::text {
namespace {

/// Scanner of a TOML text that knows strings, comments, brackets and dots: as much of the grammar as the
/// bounds need. It is never more lenient than the parser: where the two could disagree, the parser ends with
/// an error (a string without an end on its line).
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  std::optional<TextFault> scan() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // byte-order mark
    while (at_ < text_.size() && !fault_) step();
    return fault_;
  }

 private:
  void fail(const std::string& rule) { fault_ = TextFault{line_, column(), rule}; }
  [[nodiscard]] std::uint32_t column() const { return static_cast<std::uint32_t>(at_ - line_begin_ + 1); }
  [[nodiscard]] bool at(std::string_view token) const { return text_.substr(at_).starts_with(token); }

  /// Moves over one character, after checking it.
  void advance() {
    const std::size_t length = utf8_sequence(text_.substr(at_));
    const auto lead = static_cast<unsigned char>(text_[at_]);
    const bool line_feed = lead == '\n';
    const bool carriage_return = lead == '\r' && at("\r\n");
    if (length == 0) return fail("is no UTF-8 text here");
    if (lead == 0) return fail("holds a NUL byte; is this a text file?");
    if ((lead < 0x20 && lead != '\t' && !line_feed && !carriage_return) || lead == 0x7F) {
      return fail("holds the control character " + printable(text_.substr(at_, 1)));
    }
    at_ += length;
    if (line_feed) {
      ++line_;
      line_begin_ = at_;
    }
  }

  void step() {
    const char c = text_[at_];
    if (c == '#') return skip_comment();
    if (c == '"' || c == '\'') return skip_string(c);
    if (c == '.' && ++dots_ >= kMostKeyParts) {
      return fail("a key has more than " + std::to_string(kMostKeyParts) + " parts");
    }
    if (c == '[' || c == '{') {
      if (++depth_ > kMostNesting) {
        return fail("arrays and tables are nested more than " + std::to_string(kMostNesting) + " deep");
      }
    }
    if ((c == ']' || c == '}') && depth_ > 0) --depth_;
    if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) dots_ = 0;
    advance();
  }

  void skip_comment() {
    while (at_ < text_.size() && text_[at_] != '\n' && !fault_) advance();
  }

  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool multi_line = at(three);
    const std::string end = multi_line ? three : std::string(1, quote);
    for (std::size_t i = 0; i < end.size(); ++i) advance();
    while (at_ < text_.size() && !fault_) {
      if (at(end)) return close_string(quote, end.size());
      if (text_[at_] == '\n' && !multi_line) return;  // the parser refuses it
      if (quote == '"' && text_[at_] == '\\' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n') advance();
      if (!fault_ && at_ < text_.size()) advance();
    }
  }

  /// The end of a multi-line string is its last three quotes of up to five.
  void close_string(char quote, std::size_t length) {
    const std::size_t most = length == 3 ? 5 : 1;
    for (std::size_t i = 0; i < most && at_ < text_.size() && text_[at_] == quote; ++i) advance();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_begin_ = 0;
  std::uint32_t line_ = 1;
  std::size_t dots_ = 0;   // since the last separator
  std::size_t depth_ = 0;  // of open brackets
  std::optional<TextFault> fault_;
};

}  // namespace

std::optional<TextFault> toml_fault(std::string_view text) { return Scanner(text).scan(); }

}  // namespace isobar::text
