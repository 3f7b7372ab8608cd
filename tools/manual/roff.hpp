// SPDX-License-Identifier: BSD-3-Clause
// A manual page under construction, in the macros of man(7).
#pragma once

#include <string>

namespace isobar::manual {

/// One page; each function appends to it. Texts are plain: they are escaped here, and words in `backquotes`
/// become bold.
class Page {
 public:
  /// @param name of the page, "isobar-map"; @param purpose one line for whatis(1)
  Page(const std::string& name, int section, const std::string& version, const std::string& purpose);

  void heading(const std::string& text);
  void subheading(const std::string& text);
  void paragraph(const std::string& text);
  /// Lines that keep their breaks, as an example.
  void lines(const std::string& text);
  /// A term and its explanation.
  void entry(const std::string& term, const std::string& text);

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace isobar::manual
