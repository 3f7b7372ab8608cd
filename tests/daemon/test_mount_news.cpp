// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "daemon/mount_news.hpp"

namespace isobar::test::test_mount_news {

TEST_CASE("a mount is said once it is known well, and again when it has moved or its yaw has come") {
  MountNews news;
  MountState mount;
  CHECK_FALSE(news.is_news(mount));
  mount.found = true;
  mount.error_rad = {0.01, 0.0, 0.02};
  mount.sigma_rad = {0.006, 0.001, 0.02};
  CHECK_FALSE(news.is_news(mount));
  mount.sigma_rad = {0.001, 0.001, 0.02};
  CHECK(news.is_news(mount));
  CHECK_FALSE(news.is_news(mount));
  mount.error_rad[0] += 0.0029;
  mount.error_rad[2] += 0.5;  // not found yet
  CHECK_FALSE(news.is_news(mount));
  mount.error_rad[0] += 0.0002;
  CHECK(news.is_news(mount));
  CHECK_FALSE(news.is_news(mount));
  mount.yaw_found = true;
  CHECK(news.is_news(mount));
  CHECK_FALSE(news.is_news(mount));
}

}  // namespace isobar::test::test_mount_news
