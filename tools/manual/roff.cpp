// SPDX-License-Identifier: BSD-3-Clause
#include "tools/manual/roff.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace isobar::manual {
namespace {

/// Text without meaning for roff, words in `backquotes` in bold.
std::string escaped(const std::string& text) {
  std::string out;
  bool bold = false;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += bold ? "\\fR" : "\\fB";
        bold = !bold;
        break;
      default:
        out += c;
    }
  }
  return bold ? out + "\\fR" : out;
}

/// A whole input line; roff would take a point at its start for a request.
std::string line(const std::string& text) {
  return (text.starts_with('.') ? "\\&" : "") + escaped(text) + "\n";
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

}  // namespace

Page::Page(const std::string& name, int section, const std::string& version, const std::string& purpose) {
  text_ = ".\\\" Written at build time by isobar_manual, from the tables behind --help and the settings.\n";
  text_ +=
      ".TH " + upper(name) + " " + std::to_string(section) + " \"\" \"Isobar " + version + "\" \"Isobar\"\n";
  // Left-aligned, no hyphens: option and key names stay whole.
  text_ += ".ad l\n.nh\n";
  heading("Name");
  text_ += escaped(name) + " \\- " + escaped(purpose.substr(0, purpose.find_last_not_of('.') + 1)) + "\n";
}

void Page::heading(const std::string& text) { text_ += ".SH " + upper(text) + "\n"; }
void Page::subheading(const std::string& text) { text_ += ".SS " + line(text); }
void Page::paragraph(const std::string& text) { text_ += ".PP\n" + line(text); }

void Page::lines(const std::string& text) {
  text_ += ".PP\n.nf\n.RS\n";
  std::istringstream stream(text);
  for (std::string one; std::getline(stream, one);) text_ += line(one);
  text_ += ".RE\n.fi\n";
}

void Page::entry(const std::string& term, const std::string& text) {
  text_ += ".TP\n\\fB" + escaped(term) + "\\fR\n" + line(text);
}

}  // namespace isobar::manual
