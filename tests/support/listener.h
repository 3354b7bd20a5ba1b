// What a program sends to a port of this machine.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <thread>

namespace odis::test {

// Takes one connection on a free port of 127.0.0.1 and keeps all that it sends.
class Listener {
 public:
  Listener() {
    m_socket = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(m_socket, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(m_socket, 1) != 0 ||
        getsockname(m_socket, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("cannot listen on 127.0.0.1");
    m_port = ntohs(address.sin_port);
  }
  ~Listener() {
    if (m_thread.joinable()) m_thread.join();
    close(m_socket);
  }
  std::string address() const { return "127.0.0.1:" + std::to_string(m_port); }
  void start() {
    m_thread = std::thread([this] {
      const int connection = accept(m_socket, nullptr, nullptr);
      char buffer[4096];
      for (ssize_t n; (n = recv(connection, buffer, sizeof buffer, 0)) > 0;)
        m_received.append(buffer, size_t(n));
      close(connection);
    });
  }
  const std::string& received() {
    m_thread.join();
    return m_received;
  }

 private:
  int m_socket = -1, m_port = 0;
  std::thread m_thread;
  std::string m_received;
};

// An address where nobody listens: that of a port that was free a moment ago, and is closed again.
inline std::string closedAddress() {
  const Listener listener;
  return listener.address();
}

}  // namespace odis::test
