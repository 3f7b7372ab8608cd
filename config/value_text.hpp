// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "config/setting.hpp"

namespace isobar {

/// A number as a plain decimal, "200000" or "0.000003", with the fewest digits that read back to the same
/// value. With an exponent below 1e-9 and from 1e15 on, where the decimals would be all zeros.
std::string number_text(double value);

/// The value of a setting as TOML.
std::string value_text(const Setting& setting);

}  // namespace isobar
