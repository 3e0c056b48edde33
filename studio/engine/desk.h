/// What the page's engine holds between two calls, and how it answers: bytes, or text.
#pragma once

#include <array>
#include <bit>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "topple/measure.h"
#include "topple/picture.h"
#include "topple/run.h"
#include "topple/sweep.h"

#define TOPPLE_EXPORT(name) __attribute__((export_name(#name)))

namespace topple {

/// All the engine holds: the layout that was read last, the run under way, and what is asked beside it.
struct Desk {
  std::optional<Layout> layout;
  std::optional<Simulation> simulation;
  std::optional<RecordingWriter> writer;
  // A run of which only the forces at contacts are wanted: nothing is recorded.
  std::optional<Layout> watched_layout;
  std::unique_ptr<Model> watched;
  std::optional<RiskStudy> study;
  std::vector<std::uint8_t> bytes;  ///< What the last call gives back.
  std::string answer;               ///< The same of those that give text: JSON, or an error's words.
};

Desk& desk();

/// The answer becomes an error's words.
bool fail(const Error& error);

std::vector<std::string> lines_of(std::string_view text);

void add_text(std::string& json, std::string_view text);
void add_number(std::string& json, double value);

template <typename Number>
void add_bytes(std::vector<std::uint8_t>& bytes, Number number) {
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(Number)>>(number);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

}  // namespace topple
