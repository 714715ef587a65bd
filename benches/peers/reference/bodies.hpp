// A placed shape in numbers of type T: 113-bit floats where the shapes are apart, 80-bit ones where they overlap.
//
// The rotation is that of the normalised quaternion as it stands in the file. A sphere is a point and a capsule a
// segment, each with a radius that stays out of all iterations.
#pragma once

#include <quadmath.h>

#include <cmath>

#include "../pairs.hpp"

using Quad = __float128;
using Extended = long double;

inline Quad root(Quad x) { return sqrtq(x); }
inline Extended root(Extended x) { return sqrtl(x); }

template <class T>
struct Vec {
  T x, y, z;
};

template <class T>
Vec<T> operator+(Vec<T> a, Vec<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T>
Vec<T> operator-(Vec<T> a, Vec<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T>
Vec<T> operator-(Vec<T> a) { return {-a.x, -a.y, -a.z}; }
template <class T>
Vec<T> operator*(T s, Vec<T> a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T>
T dot(Vec<T> a, Vec<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T>
Vec<T> cross(Vec<T> a, Vec<T> b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
template <class T>
T length(Vec<T> a) { return root(dot(a, a)); }
template <class T>
Vec<T> unit(Vec<T> a) { return (1 / length(a)) * a; }

template <class T>
struct Body {
  const ShapeRecord* shape;
  T rotation[3][3];
  Vec<T> translation;
  T radius = 0;
  std::vector<Vec<T>> corners;  // of the core, in the world; none when the core is round

  Body(const ShapeRecord& record, const double* quaternion, const double* position) : shape(&record) {
    set_rotation(quaternion);
    translation = {position[0], position[1], position[2]};
    T p = record.params[0], q = record.params[1], r = record.params[2];
    switch (record.kind) {
      case Kind::Hull:
      case Kind::Mesh:
        for (auto& v : record.vertices) corners.push_back(to_world({v[0], v[1], v[2]}));
        break;
      case Kind::Box:
        for (int i = 0; i < 8; i++) corners.push_back(to_world({i & 1 ? p : -p, i & 2 ? q : -q, i & 4 ? r : -r}));
        break;
      case Kind::Sphere:
        corners.push_back(translation);
        radius = p;
        break;
      case Kind::Capsule:
        corners = {to_world({0, 0, q}), to_world({0, 0, -q})};
        radius = p;
        break;
      case Kind::Cylinder:
      case Kind::Cone:
      case Kind::Ellipsoid: break;
    }
  }

  Vec<T> turned(Vec<T> v) const {
    const auto& R = rotation;
    return {R[0][0] * v.x + R[0][1] * v.y + R[0][2] * v.z, R[1][0] * v.x + R[1][1] * v.y + R[1][2] * v.z,
            R[2][0] * v.x + R[2][1] * v.y + R[2][2] * v.z};
  }

  Vec<T> turned_back(Vec<T> v) const {
    const auto& R = rotation;
    return {R[0][0] * v.x + R[1][0] * v.y + R[2][0] * v.z, R[0][1] * v.x + R[1][1] * v.y + R[2][1] * v.z,
            R[0][2] * v.x + R[1][2] * v.y + R[2][2] * v.z};
  }

  Vec<T> to_world(Vec<T> v) const { return turned(v) + translation; }

  // The point of the core farthest along `direction`, in the world. Of corners, by looking at all of them.
  Vec<T> support(Vec<T> direction) const {
    if (corners.empty()) return to_world(round_support(turned_back(direction)));
    const Vec<T>* best = &corners[0];
    T greatest = dot(*best, direction);
    for (const Vec<T>& corner : corners) {
      T value = dot(corner, direction);
      if (value > greatest) {
        greatest = value;
        best = &corner;
      }
    }
    return *best;
  }

 private:
  void set_rotation(const double* quaternion) {
    T x = quaternion[0], y = quaternion[1], z = quaternion[2], w = quaternion[3];
    T norm = root(x * x + y * y + z * z + w * w);
    x /= norm;
    y /= norm;
    z /= norm;
    w /= norm;
    T rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                    {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                    {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 9; i++) rotation[i / 3][i % 3] = rows[i / 3][i % 3];
  }

  Vec<T> round_support(Vec<T> d) const {
    T p = shape->params[0], q = shape->params[1], r = shape->params[2];
    if (shape->kind == Kind::Ellipsoid) {
      Vec<T> stretched{d.x * p, d.y * q, d.z * r};
      T norm = length(stretched);
      return {stretched.x * p / norm, stretched.y * q / norm, stretched.z * r / norm};
    }
    T across = root(d.x * d.x + d.y * d.y);
    T x = across > 0 ? d.x / across : T(1), y = across > 0 ? d.y / across : T(0);
    if (shape->kind == Kind::Cylinder) return {p * x, p * y, d.z > 0 ? q : -q};
    Vec<T> rim{p * x, p * y, -q}, tip{0, 0, q};
    return dot(tip, d) > dot(rim, d) ? tip : rim;
  }
};
