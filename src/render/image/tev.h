// A client of the image viewer tev (https://github.com/Tom94/tev), to watch an image while it is rendered.
#pragma once

#include <string>
#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// "host:port", "host" (port 14158, tev's own) or ":port" (this machine).
struct TevAddress {
  // Throws std::runtime_error if the port is no number from 1 to 65535.
  explicit TevAddress(const std::string& text);

  std::string text, host, port = "14158";
};

class TevClient {
 public:
  // Connects; throws std::runtime_error with address and reason.
  explicit TevClient(const TevAddress& address);
  ~TevClient();
  TevClient(const TevClient&) = delete;
  TevClient& operator=(const TevClient&) = delete;

  // Shows linear `pixels` (width * height, row 0 at the top) under `name`; creates the image when name or
  // size are new, else updates it. Throws std::runtime_error if the viewer is gone.
  void send(const std::string& name, int width, int height, const Rgb* pixels);

 private:
  void sendPacket(std::string& packet);

  struct Known {
    std::string name;
    int width, height;
  };
  std::string m_address;
  int m_socket = -1;
  std::vector<Known> m_known;
};

}  // namespace odis::render
