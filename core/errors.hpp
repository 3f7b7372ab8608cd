// SPDX-License-Identifier: BSD-3-Clause
// Typed errors for start-up, files, configuration and devices. Hot paths return a status instead.
#pragma once

#include <stdexcept>
#include <string>

namespace isobar {

/// Base of every error that ends a command. Exit codes are those of sysexits.h.
class Error : public std::runtime_error {
 public:
  Error(const std::string& what, int exit_code) : std::runtime_error(what), exit_code_(exit_code) {}
  [[nodiscard]] int exit_code() const noexcept { return exit_code_; }

 private:
  int exit_code_;
};

/// Invalid command line (EX_USAGE, 64).
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& what) : Error(what, 64) {}
};

/// Invalid input file (EX_DATAERR, 65). Text: "file:line: rule".
class DataError : public Error {
 public:
  explicit DataError(const std::string& what) : Error(what, 65) {}
};

/// A network, shared memory or device is missing or refuses (EX_UNAVAILABLE, 69).
class ServiceError : public Error {
 public:
  explicit ServiceError(const std::string& what) : Error(what, 69) {}
};

/// Invalid configuration (EX_CONFIG, 78). Text: "file:line: key: rule".
class ConfigError : public Error {
 public:
  explicit ConfigError(const std::string& what) : Error(what, 78) {}
};

}  // namespace isobar
