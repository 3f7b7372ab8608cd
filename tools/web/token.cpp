// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/token.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/errors.hpp"
#include "run/text/small_file.hpp"

namespace isobar::web {

Token::Token(std::string text, const std::string& name) : text_(std::move(text)) {
  const bool is_printable =
      std::all_of(text_.begin(), text_.end(), [](char letter) { return letter > ' ' && letter < 127; });
  if (text_.size() < kLeastBytes || text_.size() > kMostBytes || !is_printable) {
    throw ConfigError(name + ": must hold a token of " + std::to_string(kLeastBytes) + " to " +
                      std::to_string(kMostBytes) +
                      " letters, digits and signs, such as `openssl rand -hex 24` gives");
  }
}

Token Token::read(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0 && (status.st_mode & (S_IWGRP | S_IRWXO)) != 0) {
    throw ConfigError(file.string() + ": must not be open to other users: chmod 640 " + file.string());
  }
  const text::SmallFile read = text::read_small_file(file, 2 * kMostBytes);
  if (!read.refusal.empty()) throw ConfigError(file.string() + ": " + read.refusal);
  return {read.content.substr(0, read.content.find_first_of("\r\n")), file.string()};
}

bool Token::matches(std::string_view authorization) const noexcept {
  constexpr std::string_view kScheme = "Bearer ";
  if (!authorization.starts_with(kScheme)) return false;
  const std::string_view given = authorization.substr(kScheme.size());
  // All bytes of the longest token are compared, whatever the length and wherever the first difference is.
  volatile std::size_t difference = given.size() ^ text_.size();
  for (std::size_t i = 0; i < kMostBytes; ++i) {
    const char wanted = i < text_.size() ? text_[i] : '\0';
    const char got = i < given.size() ? given[i] : '\0';
    difference = difference | static_cast<std::size_t>(static_cast<unsigned char>(wanted ^ got));
  }
  return difference == 0;
}

}  // namespace isobar::web
