// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/unit_words.hpp"

#include <array>
#include <cctype>
#include <iterator>

namespace isobar::recording {
namespace {

using Words = std::vector<std::string>;

bool is_in(const std::string& word, const auto& list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

void spell_out(std::string& text, std::string_view sign, std::string_view word) {
  for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at)) {
    text.replace(at, sign.size(), word);
  }
}

Words plain_words(std::string_view name) {
  Words words;
  std::string word;
  std::string text = lower_case(name);
  spell_out(text, "\xE2\x84\x83", " c ");  // U+2103, degree Celsius
  spell_out(text, "\xE2\x84\x89", " f ");  // U+2109, degree Fahrenheit
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

/// "inches", "of", "mercury" become "in", "hg".
void shorten(Words& words) {
  constexpr std::array<std::string_view, 2> kInches{"inch", "inches"};
  constexpr std::array<std::string_view, 4> kMillimetres{"millimeter", "millimeters", "millimetre",
                                                         "millimetres"};
  std::erase(words, "of");
  for (std::string& word : words) {
    if (is_in(word, kInches)) word = "in";
    if (is_in(word, kMillimetres)) word = "mm";
    if (word == "mercury") word = "hg";
  }
}

/// What follows the quantity in a word; the whole word is left as it is.
std::string after_quantity(const std::string& word) {
  for (const std::string_view quantity : {"temperature", "temp", "barometer", "pressure", "press", "baro"}) {
    const std::size_t at = word.rfind(quantity);
    if (at != std::string::npos) return word.substr(at + quantity.size());
  }
  return {};
}

/// The last text in brackets.
std::string_view in_brackets(std::string_view name) {
  const std::size_t begin = name.find_last_of("([{");
  if (begin == std::string_view::npos) return {};
  const std::size_t end = name.find_first_of(")]}", begin);
  return name.substr(begin + 1, end == std::string_view::npos ? end : end - begin - 1);
}

/// Words of a header beside a unit: kinds of value, places, names of sensors (with digits).
bool says_no_unit(const std::string& word) {
  constexpr std::array<std::string_view, 35> kNeutral{
      "abs",       "absolute", "air",     "ambient", "average",   "avg",        "baro",
      "barometer", "base",     "board",   "chip",    "corrected", "calibrated", "filtered",
      "indoor",    "inside",   "inst",    "local",   "max",       "mean",       "measured",
      "min",       "out",      "outdoor", "outside", "pressure",  "qfe",        "raw",
      "reference", "robot",    "sensor",  "smp",     "station",   "std",        "temperature"};
  const bool has_digit =
      std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return has_digit || is_in(word, kNeutral);
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::vector<std::string> unit_words(std::string_view name) {
  Words words = plain_words(name);
  shorten(words);
  for (std::size_t k = 1; k < words.size(); ++k) {
    if (words[k] != "hg" && words[k] != "h2o") continue;
    words[k - 1] += words[k];
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(k));
  }
  Words rests;
  for (const std::string& word : words) {
    std::string rest = after_quantity(word);
    if (!rest.empty()) rests.push_back(std::move(rest));
  }
  words.insert(words.end(), std::make_move_iterator(rests.begin()), std::make_move_iterator(rests.end()));
  return words;
}

std::string unknown_unit(std::string_view name, bool whole, bool (*is_known)(const std::string&)) {
  const std::string_view text = whole ? name : in_brackets(name);
  const Words words = unit_words(text);
  if (std::any_of(words.begin(), words.end(), is_known)) return {};
  if (std::all_of(words.begin(), words.end(), says_no_unit)) return {};
  return std::string(text);
}

}  // namespace isobar::recording
