// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/errors.hpp"

namespace isobar::test {

/// The message of the Error that `action` throws; "no error" when it throws none.
template <typename Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace isobar::test
