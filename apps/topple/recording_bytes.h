/// A recording as the page reads it.
#pragma once

#include <string>

#include "topple/recording.h"

namespace topple::app {

inline std::string recording_bytes(const Recording& recording) {
  RecordingWriter writer(recording);
  std::string bytes;
  const auto add = [&bytes](const std::vector<std::uint8_t>& piece) { bytes.append(piece.begin(), piece.end()); };
  add(writer.begin());
  add(writer.end());
  return bytes;
}

}  // namespace topple::app
