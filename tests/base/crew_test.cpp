#include "base/crew.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cstddef>
#include <initializer_list>
#include <vector>

namespace topple {

TEST_CASE("a crew of any size does every piece exactly once, round after round") {
  for (const int size : {-1, 1, 2, 3, 8}) {
    Crew crew(size);
    CHECK(crew.size() == (size < 1 ? 1 : size));
    for (const std::size_t count : std::initializer_list<std::size_t>{0, 1, 2, 7, 1000}) {
      std::vector<int> done(count, 0);
      for (int round = 0; round < 50; ++round) crew.each(count, [&](std::size_t i) { ++done[i]; });
      for (const int times : done) CHECK(times == 50);
    }
  }
}

TEST_CASE("what pieces wrote is seen by the caller, and what the caller wrote by the pieces") {
  Crew crew(3);
  std::vector<int> values(64, 1);
  for (int round = 0; round < 200; ++round) {
    crew.each(values.size(), [&](std::size_t i) { values[i] *= 2; });
    for (int& value : values) value -= 1;
  }
  for (const int value : values) CHECK(value == 1);
}

TEST_CASE("a crew that never worked ends") {
  for (int i = 0; i < 20; ++i) Crew crew(4);
}

}  // namespace topple
