// tev's protocol: packets of a 32-bit length (itself included), a type byte and the fields, all
// little-endian; strings end with a zero byte, a boolean is a byte. There are no answers.
#include "render/image/tev.h"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "render/math/interval.h"

namespace odis::render {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they lie in memory");

enum class PacketType : char { closeImage = 2, createImage = 4, updateImageV3 = 6 };

class Packet {
 public:
  explicit Packet(PacketType type) {
    put(uint32_t(0));  // the length, filled in when sent
    put(type);
  }
  template <class T>
  Packet& put(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    m_bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Packet& putText(const std::string& text) {
    m_bytes.append(text.c_str(), text.size() + 1);
    return *this;
  }
  Packet& putPixels(const Rgb* pixels, size_t count) {
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    m_bytes.append(reinterpret_cast<const char*>(pixels), count * sizeof(Rgb));
    return *this;
  }
  std::string& bytes() { return m_bytes; }

 private:
  std::string m_bytes;
};

// Connects to the first address that answers; throws with the last reason.
int connectTo(const std::string& host, const std::string& port, const std::string& address) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  if (const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found))
    throw std::runtime_error(fmt::format("cannot find tev at \"{}\": {}", address, gai_strerror(error)));
  std::string reason = "no address";
  int result = -1;
  for (const addrinfo* i = found; i && result < 0; i = i->ai_next) {
    const int candidate = socket(i->ai_family, i->ai_socktype, i->ai_protocol);
    if (candidate >= 0 && connect(candidate, i->ai_addr, i->ai_addrlen) == 0) {
      result = candidate;
      break;
    }
    reason = std::strerror(errno);
    if (candidate >= 0) close(candidate);
  }
  freeaddrinfo(found);
  if (result < 0)
    throw std::runtime_error(
        fmt::format("cannot connect to tev at \"{}\": {}; is it running?", address, reason));
  return result;
}

}  // namespace

TevAddress::TevAddress(const std::string& text) : text(text) {
  constexpr Interval<int> ports{1, 65535};
  const size_t colon = text.rfind(':');
  host = text.substr(0, colon);
  if (host.empty()) host = "127.0.0.1";
  if (colon == std::string::npos) return;
  port = text.substr(colon + 1);
  int number = 0;
  const char* const end = port.data() + port.size();
  const auto [stop, error] = std::from_chars(port.data(), end, number);
  if (error != std::errc() || stop != end || !ports.contains(number))
    throw std::runtime_error(fmt::format(
        "\"{}\" is no address of tev, expected host:port with a port from {}", text, ports.text()));
}

TevClient::TevClient(const TevAddress& address) : m_address(address.text) {
  m_socket = connectTo(address.host, address.port, address.text);
}

TevClient::~TevClient() {
  close(m_socket);
}

void TevClient::sendPacket(std::string& packet) {
  const uint32_t size = uint32_t(packet.size());
  std::memcpy(packet.data(), &size, sizeof size);
  for (size_t done = 0; done < packet.size();) {
    const ssize_t sent = ::send(m_socket, packet.data() + done, packet.size() - done, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0)
      throw std::runtime_error(
          fmt::format("cannot send to tev at \"{}\": {}", m_address, std::strerror(errno)));
    done += size_t(sent);
  }
}

void TevClient::send(const std::string& name, int width, int height, const Rgb* pixels) {
  if (width < 1 || height < 1)
    throw std::runtime_error(fmt::format("cannot show {} x {} pixels in tev", width, height));
  const auto known =
      std::find_if(m_known.begin(), m_known.end(), [&](const Known& k) { return k.name == name; });
  if (known == m_known.end() || known->width != width || known->height != height) {
    // An image of another size makes place for the new one.
    if (known != m_known.end()) {
      sendPacket(Packet(PacketType::closeImage).putText(name).bytes());
      m_known.erase(known);
    }
    Packet create(PacketType::createImage);
    create.put(true).putText(name).put(int32_t(width)).put(int32_t(height)).put(int32_t(3));
    sendPacket(create.putText("R").putText("G").putText("B").bytes());
    m_known.push_back({name, width, height});
  }
  // Bands of rows, so that no packet outgrows its 32-bit length.
  const int rows = std::max(1, int((int64_t(1) << 22) / width));
  for (int y = 0; y < height; y += rows) {
    const int band = std::min(rows, height - y);
    Packet update(PacketType::updateImageV3);
    update.put(false).putText(name).put(int32_t(3)).putText("R").putText("G").putText("B");
    update.put(int32_t(0)).put(int32_t(y)).put(int32_t(width)).put(int32_t(band));
    for (int64_t offset : {0, 1, 2}) update.put(offset);
    for (int64_t stride : {3, 3, 3}) update.put(stride);
    sendPacket(update.putPixels(pixels + size_t(y) * size_t(width), size_t(band) * size_t(width)).bytes());
  }
}

}  // namespace odis::render
