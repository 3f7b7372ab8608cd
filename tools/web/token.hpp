// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace isobar::web {

/// The secret that a request must carry to change anything.
class Token {
 public:
  static constexpr std::size_t kLeastBytes = 16;
  static constexpr std::size_t kMostBytes = 256;

  /// @param text printable ASCII without blanks
  /// @param name of the text, for errors
  /// @throws ConfigError "name: rule"
  Token(std::string text, const std::string& name);

  /// The first line of a file that only its owner and its group may read, and only its owner may write.
  /// @throws ConfigError "file: rule"
  [[nodiscard]] static Token read(const std::filesystem::path& file);

  /// @param authorization value of the header Authorization: "Bearer TOKEN". The time that this takes says nothing
  ///        about the token.
  [[nodiscard]] bool matches(std::string_view authorization) const noexcept;

 private:
  std::string text_;
};

}  // namespace isobar::web
