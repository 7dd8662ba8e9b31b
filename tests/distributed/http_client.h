// Requests byte by byte to an HTTP server of this process.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/test.h"

namespace dispersa {

inline int Connected(std::uint16_t port) {
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval patience{5, 0};
  setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(port);
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(connection, reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
  return connection;
}

// All that comes until the server closes.
inline std::string Rest(int connection) {
  std::string answer;
  char part[4096];
  for (ssize_t count; (count = recv(connection, part, sizeof part, 0)) > 0;)
    answer.append(part, static_cast<std::size_t>(count));
  close(connection);
  return answer;
}

// All that is answered to a request, until the connection ends.
inline std::string AskHttp(std::uint16_t port, const std::string& request) {
  const int connection = Connected(port);
  EXPECT_EQ(send(connection, request.data(), request.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(request.size()));
  return Rest(connection);
}

// A port that nobody has.
inline std::uint16_t FreePort() {
  const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof where;
  EXPECT_EQ(bind(probe, reinterpret_cast<const sockaddr*>(&where), size), 0);
  EXPECT_EQ(getsockname(probe, reinterpret_cast<sockaddr*>(&where), &size), 0);
  close(probe);
  return ntohs(where.sin_port);
}

}  // namespace dispersa
