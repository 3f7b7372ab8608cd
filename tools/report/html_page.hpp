// SPDX-License-Identifier: BSD-3-Clause
// The look that all reports share: one page that opens without a network.
#pragma once

#include <string>

#include "tools/report/svg.hpp"

namespace isobar::report {

/// The whole page around `body`, which is HTML; `title` is text.
std::string html_page(const std::string& title, const std::string& body);

// The rest is given text and returns HTML.
std::string heading(const std::string& text);
std::string figure(const Picture& picture, const std::string& title, const std::string& caption);
/// One item of <ul class="tiles">.
std::string tile(const std::string& label, const std::string& value, const std::string& more);

}  // namespace isobar::report
