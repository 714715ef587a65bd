// The pairs of shapes that every contender is asked about: reader of `pairs.bin`, whose layout is in README.md.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

enum class Kind : uint32_t { Hull, Sphere, Box, Capsule, Cylinder, Cone, Ellipsoid, Mesh };

struct ShapeRecord {
  Kind kind;
  double params[4];
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

struct PairSet {
  std::string name;
  uint32_t first, count;
  uint32_t track_length;  // 0: the pairs have nothing to do with one another
};

struct PairRecord {
  uint32_t a, b;
  double rotation_a[4], translation_a[3], rotation_b[4], translation_b[3];  // quaternions x y z w
};

struct Pairs {
  std::vector<ShapeRecord> shapes;
  std::vector<PairSet> sets;
  std::vector<PairRecord> pairs;

  const PairSet* set(const std::string& name) const {
    for (const PairSet& s : sets) {
      if (s.name == name) return &s;
    }
    return nullptr;
  }
};

class Reader {
 public:
  explicit Reader(const std::string& path) : file(fopen(path.c_str(), "rb")) {
    if (!file) fail(path.c_str());
  }
  ~Reader() { fclose(file); }

  void read(void* into, size_t bytes) {
    if (bytes && fread(into, 1, bytes, file) != bytes) fail("the file of pairs ends too early");
  }

  uint32_t number() {
    uint32_t value;
    read(&value, sizeof value);
    return value;
  }

  void skip_number() { number(); }

  [[noreturn]] static void fail(const char* what) {
    fprintf(stderr, "%s\n", what);
    exit(1);
  }

 private:
  FILE* file;
};

inline ShapeRecord read_shape(Reader& in) {
  ShapeRecord shape;
  shape.kind = Kind(in.number());
  shape.vertices.resize(in.number());
  shape.triangles.resize(in.number());
  in.skip_number();
  in.read(shape.params, sizeof shape.params);
  in.read(shape.vertices.data(), shape.vertices.size() * sizeof shape.vertices[0]);
  in.read(shape.triangles.data(), shape.triangles.size() * sizeof shape.triangles[0]);
  if (shape.triangles.size() % 2) in.skip_number();
  return shape;
}

inline PairSet read_set(Reader& in) {
  char name[49] = {0};
  in.read(name, 48);
  PairSet set{name, in.number(), 0, 0};
  set.count = in.number();
  set.track_length = in.number();
  in.skip_number();
  return set;
}

inline Pairs read_pairs(const std::string& path) {
  Reader in(path);
  char magic[8];
  in.read(magic, sizeof magic);
  if (memcmp(magic, "CQPAIRS1", sizeof magic)) Reader::fail("not a file of pairs");
  uint32_t shapes = in.number(), sets = in.number(), count = in.number();
  in.skip_number();
  Pairs all;
  for (uint32_t i = 0; i < shapes; i++) all.shapes.push_back(read_shape(in));
  for (uint32_t i = 0; i < sets; i++) all.sets.push_back(read_set(in));
  all.pairs.resize(count);
  for (PairRecord& pair : all.pairs) {
    pair.a = in.number();
    pair.b = in.number();
    in.read(pair.rotation_a, 14 * sizeof(double));
  }
  return all;
}
