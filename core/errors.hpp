// SPDX-License-Identifier: BSD-3-Clause
// Typed errors of the edges: start-up, files, configuration, devices. Hot paths return a status instead.
#pragma once

#include <stdexcept>
#include <string>

namespace isobar {

/// Base of every error that ends a command; the exit code follows sysexits.h.
class Error : public std::runtime_error {
 public:
  Error(const std::string& what, int exit_code) : std::runtime_error(what), exit_code_(exit_code) {}
  [[nodiscard]] int exit_code() const noexcept { return exit_code_; }

 private:
  int exit_code_;
};

/// The command line does not say something that can be done (EX_USAGE, 64).
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& what) : Error(what, 64) {}
};

/// An input file breaks a rule (EX_DATAERR, 65). Say "file:line: rule".
class DataError : public Error {
 public:
  explicit DataError(const std::string& what) : Error(what, 65) {}
};

/// Something outside the program is missing or refuses: network, shared memory, device (EX_UNAVAILABLE, 69).
class ServiceError : public Error {
 public:
  explicit ServiceError(const std::string& what) : Error(what, 69) {}
};

/// The configuration breaks a rule (EX_CONFIG, 78). Say "file:line: key: rule".
class ConfigError : public Error {
 public:
  explicit ConfigError(const std::string& what) : Error(what, 78) {}
};

}  // namespace isobar
