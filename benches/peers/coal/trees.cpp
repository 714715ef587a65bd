// Coal's broad phases as a contender. A configuration is one of them:
//
//   tree, array       DynamicAABBTreeCollisionManager, with pointers or in an array: leaves that leave their boxes are
//                     put in anew
//   sap, ssap         SaPCollisionManager, which keeps the pairs that overlap as boxes move; SSaPCollisionManager,
//                     which sorts
//
// Objects are moved and their boxes computed before the clock starts.
#include <malloc.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>

#include "../boxes.hpp"
#include "../timer.hpp"
#include "coal/broadphase/broadphase.h"
#include "coal/shape/geometric_shapes.h"

using namespace coal;
using Manager = std::unique_ptr<BroadPhaseCollisionManager>;
using Objects = std::vector<std::unique_ptr<CollisionObject>>;

struct Sample {
  double ticks, answer;
};

// Queries at the end of their list that are asked before a pass begins.
constexpr size_t WARMING = 16;

// What takes a minute and more is left out.
constexpr size_t MOST_FOR_SWEEPS = 100000;

static size_t held() {
  struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

static Manager manager(const std::string& config) {
  if (config == "tree") return Manager(new DynamicAABBTreeCollisionManager);
  if (config == "array") return Manager(new DynamicAABBTreeArrayCollisionManager);
  if (config == "sap") return Manager(new SaPCollisionManager);
  return Manager(new SSaPCollisionManager);
}

static Vec3s centre(const BoxRecord& box) {
  return Vec3s((box[0] + box[3]) / 2, (box[1] + box[4]) / 2, (box[2] + box[5]) / 2);
}

static std::unique_ptr<CollisionObject> object(const BoxRecord& box) {
  auto shape = std::make_shared<Box>(box[3] - box[0], box[4] - box[1], box[5] - box[2]);
  return std::make_unique<CollisionObject>(shape, Matrix3s::Identity(), centre(box));
}

static void place(CollisionObject& object, const BoxRecord& box) {
  object.setTranslation(centre(box));
  object.computeAABB();
}

// The finaliser of SplitMix64: a number for a pair, so that sums of them tell sets of pairs apart.
static uint64_t mixed(uint64_t low, uint64_t high) {
  uint64_t x = low << 32 | high;
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9;
  x = (x ^ x >> 27) * 0x94D049BB133111EB;
  return x ^ x >> 31;
}

struct Count : CollisionCallBackBase {
  size_t found = 0;
  bool collide(CollisionObject* a, CollisionObject* b) override {
    found += a->getAABB().overlap(b->getAABB());
    return false;
  }
};

struct Sum : CollisionCallBackBase {
  uint64_t sum = 0;
  bool collide(CollisionObject* a, CollisionObject* b) override {
    if (!a->getAABB().overlap(b->getAABB())) return false;
    auto i = uint64_t(a->getUserData()), j = uint64_t(b->getUserData());
    sum += mixed(std::min(i, j), std::max(i, j));
    return false;
  }
};

// A manager that has taken part in moves, with objects of its own.
struct Kept {
  Objects objects;
  Manager manager;
  uint64_t frames;       // after which its objects are where they are
  size_t built, bytes;   // when it was built, and now; without the objects

  std::vector<CollisionObject*> pointers() const {
    std::vector<CollisionObject*> all;
    for (auto& object : objects) all.push_back(object.get());
    return all;
  }
};

class Session {
 public:
  explicit Session(const std::string& path) : data(path), before(data.boxes) {}

  size_t size() const { return data.boxes.size(); }

  std::vector<std::string> configs(const std::string& operation) const {
    if (operation == "ray" || operation == "publish") return {};
    if (size() > MOST_FOR_SWEEPS) return {"tree", "array"};
    return {"tree", "array", "sap", "ssap"};
  }

  // Reads frames for the next passes of `moves`; every manager is behind until its pass.
  void read_frames(uint32_t percent, uint32_t first, uint32_t count) {
    before = data.boxes;
    frames.clear();
    for (uint32_t index = first; index < first + count; index++) {
      std::vector<std::pair<uint32_t, BoxRecord>> frame;
      for (const Move& move : data.frame(percent, index)) {
        BoxRecord& box = data.boxes[move.index];
        for (int axis = 0; axis < 3; axis++) {
          box[axis] += double(move.by[axis]);
          box[axis + 3] += double(move.by[axis]);
        }
        frame.push_back({move.index, box});
      }
      frames.push_back(std::move(frame));
    }
    read++;
  }

  std::vector<Sample> pass(const std::string& operation, const std::string& config, size_t count) {
    std::vector<Sample> samples;
    if (operation == "build") {
      Objects objects = objects_at(data.boxes);
      std::vector<CollisionObject*> all;
      for (auto& object : objects) all.push_back(object.get());
      for (size_t i = 0; i < count; i++) {
        Manager built = manager(config);
        samples.push_back(time([&] { built->registerObjects(all), built->setup(); }, [] { return 0.0; }));
      }
      return samples;
    }
    Kept& one = keep(config, operation == "moves" ? read - 1 : read);
    BroadPhaseCollisionManager& broad = *one.manager;
    if (operation == "moves") {
      samples.reserve(frames.size());
      for (auto& frame : frames) {
        std::vector<CollisionObject*> moved;
        for (auto& [index, box] : frame) {
          place(*one.objects[index], box);
          moved.push_back(one.objects[index].get());
        }
        size_t start = held();
        auto change = [&] { moved.size() == size() ? broad.update() : broad.update(moved); };
        samples.push_back(time(change, [&] { return double(moved.size()); }));
        one.bytes += held() - start;
      }
      one.frames = read;
    } else if (operation == "pairs") {
      for (size_t i = 0; i < count; i++) {
        Count pairs;
        samples.push_back(time([&] { broad.collide(&pairs); }, [&] { return double(pairs.found); }));
      }
    } else if (operation == "pair_sum") {
      Sum pairs;
      broad.collide(&pairs);
      samples.push_back({0, double(pairs.sum >> 12)});
    } else {
      Objects queries;
      for (size_t i = 0; i < std::min(count, data.queries.size()); i++) queries.push_back(object(data.queries[i]));
      auto ask = [&](CollisionObject& query) {
        Count met;
        return time([&] { broad.collide(&query, &met); }, [&] { return double(met.found); });
      };
      // Not counted: another program ran before, and the processor has to find its way again.
      for (size_t i = queries.size() - std::min(queries.size(), WARMING); i < queries.size(); i++) ask(*queries[i]);
      for (auto& query : queries) samples.push_back(ask(*query));
    }
    return samples;
  }

  std::pair<size_t, size_t> memory(const std::string& config) const {
    auto found = kept.find(config);
    return found == kept.end() ? std::pair<size_t, size_t>() : std::pair(found->second.built, found->second.bytes);
  }

  ::Timer timer;

 private:
  Boxes data;
  std::vector<BoxRecord> before;  // the frames that were read last
  std::vector<std::vector<std::pair<uint32_t, BoxRecord>>> frames;
  uint64_t read = 0;  // how often frames were read
  std::map<std::string, Kept> kept;

  template <class Ask, class Answer>
  Sample time(Ask&& ask, Answer&& answer) const {
    uint64_t start = tick();
    ask();
    uint64_t end = tick();
    return {double(end - start) - timer.cost, answer()};
  }

  static Objects objects_at(const std::vector<BoxRecord>& boxes) {
    Objects objects;
    for (auto& box : boxes) {
      objects.push_back(object(box));
      objects.back()->setUserData(reinterpret_cast<void*>(objects.size() - 1));
    }
    return objects;
  }

  // The manager of that configuration, with the boxes as they are after so many readings of frames (now or one less):
  // as its moves have left it, or built anew where it took no part in the last.
  Kept& keep(const std::string& config, uint64_t wanted) {
    auto found = kept.find(config);
    if (found != kept.end() && found->second.frames == wanted) return found->second;
    kept.erase(config);
    Kept& one = kept[config];
    one.objects = objects_at(wanted == read ? data.boxes : before);
    auto all = one.pointers();
    size_t start = held();
    one.manager = manager(config);
    one.manager->registerObjects(all);
    one.manager->setup();
    one.built = one.bytes = held() - start;
    one.frames = wanted;
    return one;
  }
};

int main() {
  printf("ready %.9f %g\n", ticks_per_nanosecond(), ::Timer().step);
  fflush(stdout);
  std::unique_ptr<Session> session;
  for (std::string line; std::getline(std::cin, line); fflush(stdout)) {
    std::istringstream words(line);
    std::string command, operation, config;
    words >> command;
    if (command == "open") {
      std::string path;
      words >> path;
      session.reset();  // the memory of the one before is free before the next is read
      session = std::make_unique<Session>(path);
      printf("opened %zu\n", session->size());
    } else if (!session) {
      Boxes::fail(("no such command: " + line).c_str());
    } else if (command == "configs") {
      words >> operation;
      for (auto& name : session->configs(operation)) printf("%s ", name.c_str());
      printf("\n");
    } else if (command == "frames") {
      uint32_t percent, first, count;
      words >> percent >> first >> count;
      session->read_frames(percent, first, count);
      printf("read\n");
    } else if (command == "pass") {
      size_t count;
      words >> operation >> config >> count;
      auto samples = session->pass(operation, config, count);
      printf("samples %zu\n", samples.size());
      fwrite(samples.data(), sizeof(Sample), samples.size(), stdout);
    } else if (command == "memory") {
      words >> config;
      auto [built, bytes] = session->memory(config);
      printf("%zu %zu\n", built, bytes);
    } else {
      Boxes::fail(("no such command: " + line).c_str());
    }
  }
  return 0;
}
