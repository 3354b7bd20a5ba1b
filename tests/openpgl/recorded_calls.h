// What a renderer called of Open PGL's interface, in a file that bench/openpgl_recorder.cpp writes: each
// record is a byte, a RecordedCall, and what that is followed by, as it lies in memory on x86-64. A path,
// or a vertex with its questions, lies there in one piece, whatever other threads called meanwhile.
#pragma once

#include <openpgl/openpgl.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace odis::test {

enum class RecordedCall : char {
  kSegment = 's',  // PGLPathSegmentData that the host filled in
  kCopied = 'c',   // PGLPathSegmentData that it handed over complete
  kPath = 'p',     // the segments since the last one are a path
  kVertex = 'v',   // pgl_point3f and pgl_vec3f: a distribution at a position with a normal
  kPdf = 'd',      // pgl_vec3f: the density there of a direction
  kSample = 'r',   // pgl_point2f: a direction there for two numbers
  kUpdate = 'u',   // the field learned from the paths
};

// A path, or what was asked at a vertex.
struct RecordedSegment {
  bool isCopied;
  PGLPathSegmentData data;
};
using RecordedPath = std::vector<RecordedSegment>;
struct RecordedVertex {
  struct Question {
    bool samples;
    pgl_vec3f direction;
    pgl_point2f numbers;
  };
  pgl_point3f position;
  pgl_vec3f normal;
  std::vector<Question> questions;
};

// What was called between two updates of the field. Paths and vertices do not depend on each other.
struct RecordedRound {
  std::vector<RecordedVertex> vertices;
  std::vector<RecordedPath> paths;
  bool isUpdated = false;
};

// Throws std::runtime_error where a file can't be read, is cut off or holds something else.
inline std::vector<RecordedRound> readRecordedCalls(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  if (bytes.empty()) throw std::runtime_error(file + ": can't be read");
  size_t next = 0;
  // The next value of the type of its argument.
  const auto take = [&](auto value) {
    if (bytes.size() - next < sizeof value) throw std::runtime_error(file + ": is cut off");
    std::memcpy(&value, bytes.data() + next, sizeof value);
    next += sizeof value;
    return value;
  };

  std::vector<RecordedRound> rounds(1);
  RecordedPath path;
  const auto ask = [&](const RecordedVertex::Question& question) {
    if (rounds.back().vertices.empty()) throw std::runtime_error(file + ": a question without a vertex");
    rounds.back().vertices.back().questions.push_back(question);
  };
  while (next < bytes.size()) {
    switch (const auto call = take(RecordedCall())) {
      case RecordedCall::kSegment:
      case RecordedCall::kCopied:
        path.push_back({call == RecordedCall::kCopied, take(PGLPathSegmentData())});
        break;
      case RecordedCall::kPath:
        rounds.back().paths.push_back(std::move(path));
        path.clear();
        break;
      case RecordedCall::kVertex:
        rounds.back().vertices.push_back({take(pgl_point3f()), take(pgl_vec3f()), {}});
        break;
      case RecordedCall::kPdf:
        ask({false, take(pgl_vec3f()), {}});
        break;
      case RecordedCall::kSample:
        ask({true, {}, take(pgl_point2f())});
        break;
      case RecordedCall::kUpdate:
        rounds.back().isUpdated = true;
        rounds.emplace_back();
        break;
      default:
        throw std::runtime_error(file + ": byte " + std::to_string(next - 1) + " is no call");
    }
  }
  return rounds;
}

}  // namespace odis::test
