/// Numbers as the bytes that messages have them in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace clearance {

inline void append_double(std::string& bytes, double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 8; ++i) bytes += static_cast<char>(bits >> (8 * i));
}

/// The numbers of a bulk answer; none of an empty field.
inline std::vector<double> doubles_of(const std::string& bytes) {
  std::vector<double> values(bytes.size() / 8);
  for (std::size_t k = 0; k < values.size(); ++k) {
    std::uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) bits |= std::uint64_t{static_cast<unsigned char>(bytes[8 * k + i])} << (8 * i);
    std::memcpy(&values[k], &bits, sizeof bits);
  }
  return values;
}

}  // namespace clearance
