// Checks that bytes from the network are what a decoder expects, before it allocates anything.
#pragma once

#include <cstddef>
#include <cstdint>

#include <dispersionPubSubTypes.h>

namespace dispersa {

/// No sample that we exchange is larger: longer texts travel in parts.
inline constexpr std::size_t kMaxSampleBytes = 1 << 20;

/// True if `data` is a whole sample in plain little-endian CDR of the given shape. s: string, Q: 64 bits, I:
/// 32 bits, B: 8 bits, [...]: a sequence of the enclosed. The generated decoders trust the lengths that a
/// sample declares. Seven bytes can make them allocate 34 GB, or throw from a thread of the middleware.
bool HasShape(const char* shape, const std::uint8_t* data, std::size_t size);

/// The shape of each type of idl/dispersion.idl.
template <typename PubSubType>
struct WireShape;
#define DISPERSA_WIRE_SHAPE(type, text)     \
  template <>                               \
  struct WireShape<idl::type##PubSubType> { \
    static constexpr char value[] = text;   \
  }
DISPERSA_WIRE_SHAPE(WorkerStatusV2, "ssIsIIIQQ[Q][QQ]");
DISPERSA_WIRE_SHAPE(OrdersV1, "sQ[sQ[Q]][Q][Q]Bs");
DISPERSA_WIRE_SHAPE(ReportV3, "sQQs[QQsQIs[Q]QQ[Q]QQ[sQQQQQ]][QQ]");
DISPERSA_WIRE_SHAPE(TextRequestV1, "ssQ");
DISPERSA_WIRE_SHAPE(TextV1, "ssssQQ[B]");
DISPERSA_WIRE_SHAPE(CampaignRefusalV2, "sQssB");
DISPERSA_WIRE_SHAPE(ProgressV1, "QssssQQQQI");
DISPERSA_WIRE_SHAPE(ResultV2, "ssQQsQIs[Q]QQ[Q]QQ[sQQQQQ]");
DISPERSA_WIRE_SHAPE(RequestV1, "sQss[B]");
DISPERSA_WIRE_SHAPE(ReplyV1, "sQIs[B]");
#undef DISPERSA_WIRE_SHAPE

}  // namespace dispersa
