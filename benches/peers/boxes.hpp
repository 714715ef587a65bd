// The boxes that every tree is made of, how they move, and what is asked of them: reader of `trees_N.bin` (see README.md).
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

using BoxRecord = std::array<double, 6>;  // least corner, then greatest corner, metres
using RayRecord = std::array<double, 7>;  // origin, unit direction, length, metres

struct Move {
  uint32_t index;
  float by[3];  // metres
};
static_assert(sizeof(Move) == 16, "as in the file");

// The file, of which frames are read as they are asked for.
class Boxes {
 public:
  std::vector<BoxRecord> boxes, queries;
  std::vector<RayRecord> rays;

  explicit Boxes(const std::string& path) : file(fopen(path.c_str(), "rb")) {
    if (!file) fail(path.c_str());
    char magic[8];
    read(magic, 8);
    if (memcmp(magic, "CQTREES1", 8)) fail("not a file of boxes");
    uint32_t counts[4];
    read(counts, sizeof counts);
    std::vector<uint32_t> heads(2 * counts[3]);
    read(heads.data(), 4 * heads.size());
    boxes.resize(counts[0]);
    queries.resize(counts[1]);
    rays.resize(counts[2]);
    read(boxes.data(), sizeof(BoxRecord) * boxes.size());
    read(queries.data(), sizeof(BoxRecord) * queries.size());
    read(rays.data(), sizeof(RayRecord) * rays.size());
    long offset = ftell(file);
    for (size_t i = 0; i < heads.size(); i += 2) {
      size_t moves = size_t(counts[0]) * heads[i] / 100;
      streams.push_back({heads[i], heads[i + 1], moves, offset});
      offset += long(heads[i + 1] * moves * sizeof(Move));
    }
  }
  ~Boxes() { fclose(file); }
  Boxes(const Boxes&) = delete;
  Boxes& operator=(const Boxes&) = delete;

  // Frame `index` of those that move `percent` of the boxes.
  std::vector<Move> frame(uint32_t percent, uint32_t index) {
    for (const Stream& stream : streams) {
      if (stream.percent != percent || index >= stream.frames) continue;
      std::vector<Move> moves(stream.moves);
      fseek(file, stream.offset + long(index * moves.size() * sizeof(Move)), SEEK_SET);
      read(moves.data(), moves.size() * sizeof(Move));
      return moves;
    }
    fail("no such frame");
  }

  [[noreturn]] static void fail(const char* what) {
    fprintf(stderr, "%s\n", what);
    exit(1);
  }

 private:
  // Frames that move the same share of the boxes.
  struct Stream {
    uint32_t percent, frames;
    size_t moves;
    long offset;
  };

  void read(void* to, size_t bytes) {
    if (bytes && fread(to, 1, bytes, file) != bytes) fail("the file of boxes ends early");
  }

  FILE* file;
  std::vector<Stream> streams;
};
