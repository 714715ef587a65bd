// ProxQP (proxsuite, its dense solver) as a contender: the distance of two hulls as a quadratic program. A configuration is words
// joined by "/":
//
//   faces                     min |R x + t - y|^2 / 2 with x behind the faces of one hull and y behind those of the other:
//                             six unknowns, a constraint for each face
//   weights                   the same of the points that weights of the corners make: an unknown for each corner, none
//                             negative, two sums that are one; hulls of up to 300 corners
//   scaled                    with ProxQP's preconditioner; without it otherwise (rows are unit normals as they are)
//   1e-05, 1e-09              the absolute tolerance of its residuals
//
// Constraints do not depend on where the bodies are and are made before the clock starts, as is room for the solver. What a call
// does: the matrix and vector of the objective from both poses, `init` and `solve`. Overlaps come out as a distance of nearly
// nothing; what it gives up on is no answer.
#include <proxsuite/proxqp/dense/dense.hpp>

#include <map>
#include <memory>

#include "../contender.hpp"

using namespace proxsuite::proxqp;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Solver = dense::QP<double>;

constexpr size_t MOST_CORNERS = 300;

static Eigen::Vector3d vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// The faces of a hull: unit normals outward, each once, and how far along them the hull reaches.
struct Faces {
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> heights;

  explicit Faces(const ShapeRecord& shape) {
    for (auto& t : shape.triangles) {
      Eigen::Vector3d a = vector(shape.vertices[t[0]]), b = vector(shape.vertices[t[1]]), c = vector(shape.vertices[t[2]]);
      Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
      bool known = std::any_of(normals.begin(), normals.end(), [&](auto& n) { return (n - normal).norm() < 1e-9; });
      if (known) continue;
      double height = -INFINITY;
      for (auto& v : shape.vertices) height = std::max(height, normal.dot(vector(v)));
      normals.push_back(normal);
      heights.push_back(height);
    }
  }
};

// One quadratic program, but for its objective: H and g are filled in for each question.
struct Program {
  Matrix H, A, C;
  Vector g, b, l, u;
  // The points of both hulls for unknowns of value one: their coordinates in their own frames, in columns.
  Matrix of_a, of_b;
};

static Program by_faces(const Faces& a, const Faces& b) {
  Eigen::Index count_a = a.normals.size(), count_b = b.normals.size();
  Program p;
  p.A.resize(0, 6);
  p.b.resize(0);
  p.C = Matrix::Zero(count_a + count_b, 6);
  p.u.resize(count_a + count_b);
  for (Eigen::Index i = 0; i < count_a; i++) p.C.block<1, 3>(i, 0) = a.normals[i].transpose(), p.u[i] = a.heights[i];
  for (Eigen::Index i = 0; i < count_b; i++) {
    p.C.block<1, 3>(count_a + i, 3) = b.normals[i].transpose();
    p.u[count_a + i] = b.heights[i];
  }
  p.l = Vector::Constant(count_a + count_b, -1e20);
  p.of_a = p.of_b = Matrix::Identity(3, 3);
  return p;
}

static Matrix corners(const ShapeRecord& shape) {
  Matrix points(3, shape.vertices.size());
  for (size_t i = 0; i < shape.vertices.size(); i++) points.col(i) = vector(shape.vertices[i]);
  return points;
}

static Program by_weights(const ShapeRecord& a, const ShapeRecord& b) {
  Program p;
  p.of_a = corners(a);
  p.of_b = corners(b);
  Eigen::Index n = p.of_a.cols() + p.of_b.cols();
  p.A = Matrix::Zero(2, n);
  p.A.row(0).head(p.of_a.cols()).setOnes();
  p.A.row(1).tail(p.of_b.cols()).setOnes();
  p.b = Vector::Ones(2);
  p.C = Matrix::Identity(n, n);
  p.l = Vector::Zero(n);
  p.u = Vector::Constant(n, 1e20);
  return p;
}

static bool contains(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

class ProxQp {
 public:
  explicit ProxQp(const Pairs& pairs) : all(pairs) {}

  std::vector<std::string> configs(const PairSet& set, const std::string& operation) const {
    if (set.name.rfind("seed", 0) != 0 || operation != "distance") return {};
    std::vector<std::string> forms = {"faces"};
    if (all.shapes[all.pairs[set.first].a].vertices.size() <= MOST_CORNERS) forms.push_back("weights");
    std::vector<std::string> names;
    for (const std::string& form : forms) {
      for (const char* tolerance : {"1e-05", "1e-09"}) {
        names.push_back(form + "/" + tolerance);
        names.push_back(form + "/scaled/" + tolerance);
      }
    }
    return names;
  }

  void ask(const PairSet& set, const std::string&, const std::string& config, Pass& pass) {
    prepare(set, contains(config, "weights"), config);
    bool scaled = contains(config, "scaled");
    pass.run([&](size_t i) {
      const PairRecord& pair = all.pairs[set.first + i];
      Program& p = *programs[i];
      Solver& solver = *solvers[i];
      Eigen::Quaterniond at_a(pair.rotation_a[3], pair.rotation_a[0], pair.rotation_a[1], pair.rotation_a[2]);
      Eigen::Quaterniond at_b(pair.rotation_b[3], pair.rotation_b[0], pair.rotation_b[1], pair.rotation_b[2]);
      Eigen::Map<const Eigen::Vector3d> from(pair.translation_b), to(pair.translation_a);
      // In the frame of B: R x + t - y.
      Eigen::Matrix3d turn = (at_b.conjugate() * at_a).toRotationMatrix();
      Eigen::Vector3d t = at_b.conjugate() * (to - from);
      objective(p, turn, t);
      solver.init(p.H, p.g, p.A, p.b, p.C, p.l, p.u, scaled);
      solver.solve();
      if (solver.results.info.status != QPSolverOutput::PROXQP_SOLVED) return double(NAN);
      const Vector& x = solver.results.x;
      return (turn * (p.of_a * x.head(p.of_a.cols())) + t - p.of_b * x.tail(p.of_b.cols())).norm();
    });
  }

 private:
  static void objective(Program& p, const Eigen::Matrix3d& turn, const Eigen::Vector3d& t) {
    Eigen::Index a = p.of_a.cols(), b = p.of_b.cols();
    across.resize(3, a + b);
    across.leftCols(a).noalias() = turn * p.of_a;
    across.rightCols(b) = -p.of_b;
    p.H.noalias() = across.transpose() * across;
    p.g.noalias() = across.transpose() * t;
  }

  // Room for a solver for each size of a program, kept over all pairs; nothing of one answer helps the next.
  void prepare(const PairSet& set, bool weights, const std::string& config) {
    if (prepared == set.name + config) return;
    prepared = set.name + config;
    programs.clear();
    solvers.clear();
    std::map<std::array<uint32_t, 2>, std::shared_ptr<Program>> made;
    std::map<std::array<Eigen::Index, 3>, std::shared_ptr<Solver>> rooms;
    for (uint32_t i = 0; i < set.count; i++) {
      const PairRecord& pair = all.pairs[set.first + i];
      auto& program = made[{pair.a, pair.b}];
      if (!program) {
        const ShapeRecord &a = all.shapes[pair.a], &b = all.shapes[pair.b];
        program = std::make_shared<Program>(weights ? by_weights(a, b) : by_faces(faces(pair.a), faces(pair.b)));
        Eigen::Index n = program->of_a.cols() + program->of_b.cols();
        program->H.resize(n, n);
        program->g.resize(n);
      }
      Eigen::Index n = program->g.size(), equalities = program->b.size(), inequalities = program->u.size();
      auto& room = rooms[{n, equalities, inequalities}];
      if (!room) {
        room = std::make_shared<Solver>(n, equalities, inequalities);
        room->settings.eps_abs = contains(config, "1e-09") ? 1e-9 : 1e-5;
        room->settings.eps_rel = 0;
        room->settings.initial_guess = InitialGuessStatus::NO_INITIAL_GUESS;
      }
      programs.push_back(program);
      solvers.push_back(room);
    }
  }

  const Faces& faces(uint32_t shape) {
    auto found = known.find(shape);
    if (found == known.end()) found = known.emplace(shape, Faces(all.shapes[shape])).first;
    return found->second;
  }

  static inline Matrix across;
  const Pairs& all;
  std::map<uint32_t, Faces> known;
  std::string prepared;
  std::vector<std::shared_ptr<Program>> programs;
  std::vector<std::shared_ptr<Solver>> solvers;
};

int main(int, char** argv) {
  Pairs pairs = read_pairs(argv[1]);
  ProxQp proxqp(pairs);
  return serve(proxqp, pairs);
}
