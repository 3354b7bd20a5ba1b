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
struct RecordedPath {
  struct Segment {
    bool isCopied;
    PGLPathSegmentData data;
  };
  std::vector<Segment> segments;
};
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

class RecordedCalls {
 public:
  explicit RecordedCalls(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    m_bytes.assign(std::istreambuf_iterator<char>(in), {});
    if (m_bytes.empty()) throw std::runtime_error(file + ": can't be read");
  }

  std::vector<RecordedRound> rounds() {
    std::vector<RecordedRound> rounds(1);
    RecordedPath path;
    for (m_next = 0; m_next < m_bytes.size();) {
      RecordedRound& round = rounds.back();
      switch (const auto call = take<RecordedCall>()) {
        case RecordedCall::kSegment:
        case RecordedCall::kCopied:
          path.segments.push_back({call == RecordedCall::kCopied, take<PGLPathSegmentData>()});
          break;
        case RecordedCall::kPath:
          round.paths.push_back(std::move(path));
          path = {};
          break;
        case RecordedCall::kVertex:
          round.vertices.push_back({take<pgl_point3f>(), take<pgl_vec3f>(), {}});
          break;
        case RecordedCall::kPdf:
          round.vertices.back().questions.push_back({false, take<pgl_vec3f>(), {}});
          break;
        case RecordedCall::kSample:
          round.vertices.back().questions.push_back({true, {}, take<pgl_point2f>()});
          break;
        case RecordedCall::kUpdate:
          round.isUpdated = true;
          rounds.emplace_back();
          break;
        default:
          throw std::runtime_error("recorded calls: byte " + std::to_string(m_next - 1) + " is no call");
      }
    }
    return rounds;
  }

 private:
  template <class T>
  T take() {
    if (m_bytes.size() - m_next < sizeof(T)) throw std::runtime_error("recorded calls: the file is cut off");
    T value;
    std::memcpy(&value, m_bytes.data() + m_next, sizeof(T));
    m_next += sizeof(T);
    return value;
  }

  std::string m_bytes;
  size_t m_next = 0;
};

}  // namespace odis::test
