// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <string>

#include "core/errors.hpp"
#include "tools/web/inline_text.hpp"
#include "tools/web/page_files.hpp"

namespace isobar::test::test_inline_text {

using namespace isobar::web;

TEST_CASE("base64 is that of RFC 4648's examples") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
}

TEST_CASE("no text in JSON can end the script element that holds it") {
  CHECK(script_safe(R"({"a":"</script><!--"})") == R"({"a":"\u003c/script>\u003c!--"})");
}

TEST_CASE("the embedded parts unpack to a script and a style; damaged bytes are refused") {
  if (!inline_parts(InlinePage::kReport)) {
    MESSAGE("skipped: built without npm");
    return;
  }
  for (const InlinePage page : {InlinePage::kRun, InlinePage::kCharts, InlinePage::kReport}) {
    const auto parts = inline_parts(page);
    CHECK(parts->script.find(page == InlinePage::kRun ? "isobar-view" : "isobar-chart") != std::string::npos);
    // It stands in a script element of its own.
    CHECK(parts->script.find("</script") == std::string::npos);
    CHECK(parts->style.find(page == InlinePage::kRun ? ".map" : ".curve-chart") != std::string::npos);
  }
  CHECK_THROWS_AS((void)unpacked("no gzip"), ServiceError);
}

}  // namespace isobar::test::test_inline_text
