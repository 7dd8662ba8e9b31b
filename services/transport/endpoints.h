// Readers and writers with the quality of service of all our topics (idl/README.md). Internal to this folder.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "services/program/mutex.h"
#include "services/transport/complaints.h"
#include "services/transport/convert.h"
#include "services/transport/fast_dds.h"
#include "services/transport/participant.h"
#include "services/transport/seal.h"
#include "services/transport/validity.h"
#include "services/transport/wire_shape.h"

namespace dispersa {

/// Samples that a writer keeps for a reader that has not acknowledged them, and that a reader keeps for us.
/// Older ones are dropped; the side that needs them repeats them. So a reader that stops reading has a
/// limited cost.
inline constexpr int kDepth = 512;
/// Number of samples after which a writer is replaced, so that no reader has to skip more (sieve.h).
inline constexpr std::uint64_t kRenewAfter = 1 << 20;

/// A "reader" or "writer" that the middleware does not make: mostly because the keys do not allow its topic.
inline NetworkError NotCreated(const char* end, const std::string& topic) {
  return NetworkError(std::string("cannot create a ") + end + " of " + topic +
                      "; if the keys are of an older release, issue them again");
}

dds::DataWriterQos MakeWriterQos(int depth);
/// With a socket of its own on `port`, if that is not 0.
dds::DataReaderQos MakeReaderQos(const std::string& address, std::uint16_t port);

/// Reports a mismatch of quality of service, which would otherwise be silent.
void LogIncompatibleQos(const std::string& topic, dds::QosPolicyId_t policy);

/// The participant that an endpoint belongs to: the same for all topics of one sender.
std::string ParticipantOf(const rtps::InstanceHandle_t& endpoint);

/// A seal, and the bytes before it that fill the content to a multiple of 4. The middleware would add them
/// after it.
inline constexpr std::uint32_t kRoomForSeal = Seal::kSize + 3;
/// False: there is no room.
bool PutSeal(const Seal& seal, const std::string& topic, const Seal::Origin& origin,
             rtps::SerializedPayload_t& payload);
/// The name of a writer in a seal.
Seal::Writer NameOfWriter(const rtps::GUID_t& writer);

/// The numbers of seals grow. A repeated number is not believed.
class HeardSeals {
 public:
  /// Whether the sample of this writer was sealed by it, and comes for the first time.
  bool IsNew(const rtps::InstanceHandle_t& writer, const Seal::Origin& origin);

 private:
  std::map<Seal::Writer, std::uint64_t> last_;  ///< of writers that have the secret
};

/// A decoder that neither throws nor allocates more than a sample's size. A refused sample is handed over
/// empty with `refused` set, so that the reader can name its sender.
///
/// With a seal (made from a secret that both sides have) a sample ends with it. A sample whose seal does not
/// fit is refused before its content is read.
template <typename PubSubType>
class GuardedType : public CodedType<PubSubType> {
 public:
  explicit GuardedType(std::shared_ptr<const Seal> seal = nullptr, std::string topic = "")
      : seal_(std::move(seal)), topic_(std::move(topic)) {}

  bool Encode(const void* data, rtps::SerializedPayload_t& payload) override {
    return this->EncodePlain(data, payload) &&
           (seal_ == nullptr || PutSeal(*seal_, topic_, writing, payload));
  }
  std::uint32_t SizeOf(const void* data) override {
    return this->PlainSizeOf(data) + (seal_ == nullptr ? 0 : kRoomForSeal);
  }
  bool Decode(rtps::SerializedPayload_t& payload, void* data) override {
    using Message = typename PubSubType::type;
    const std::uint32_t whole = payload.length;
    is_foreign = seal_ != nullptr && !seal_->Fits(topic_, payload.data, payload.length, &read);
    if (is_foreign) {
      refused = true;
      *static_cast<Message*>(data) = Message();
      return true;
    }
    if (seal_ != nullptr) payload.length -= static_cast<std::uint32_t>(Seal::kSize);
    try {
      refused = !HasShape(WireShape<PubSubType>::value, payload.data, payload.length) ||
                !this->DecodePlain(payload, data);
    } catch (const std::exception&) {
      refused = true;
    }
    if (refused) *static_cast<Message*>(data) = Message();
    payload.length = whole;
    return true;
  }
  /// Whether the last sample decoded by this thread was refused.
  static inline thread_local bool refused = false;
  /// The same, because no seal fits.
  static inline thread_local bool is_foreign = false;
  /// Origins of the last sample read by this thread, and of the sample that it writes.
  static inline thread_local Seal::Origin read, writing;

 private:
  std::shared_ptr<const Seal> seal_;
  std::string topic_;
};

/// The worker or client that sends a message, or receives it.
template <typename Plain>
const std::string& NameIn(const Plain& message) {
  if constexpr (requires { message.client; }) {
    return message.client;
  } else {
    return message.worker;
  }
}

/// Thread-safe.
template <typename PubSubType>
class Writer : private dds::DataWriterListener {
 public:
  using Message = typename PubSubType::type;

  Writer(Participant& participant, dds::Publisher* publisher, const std::string& topic, int depth = kDepth)
      : name_(topic),
        topic_(participant.TopicOf<GuardedType<PubSubType>>(topic)),
        depth_(depth),
        publisher_(publisher) {
    Open();
  }
  ~Writer() override { Close(); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// A message that cannot be sent now is lost. The sender repeats it if needed.
  void Write(Message message) {
    const Lock lock(mutex_);
    if (++written_ > kRenewAfter) {
      Close();
      Open();
    }
    using Type = GuardedType<PubSubType>;
    Type::writing = {NameOfWriter(writer_->guid()), number_ = NextSealNumber(number_)};
    writer_->write(&message);
  }
  int matched() const {
    const Lock lock(mutex_);
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }
  /// Waits until written messages have arrived.
  void Drain(int milliseconds) {
    const Lock lock(mutex_);
    writer_->wait_for_acknowledgments(
        {milliseconds / 1000, static_cast<unsigned>(milliseconds % 1000) * 1000000u});
  }

 private:
  void on_offered_incompatible_qos(dds::DataWriter*,
                                   const dds::OfferedIncompatibleQosStatus& status) override {
    LogIncompatibleQos(name_, status.last_policy_id);
  }
  void Open() DISPERSA_PROVED(requires_capability(mutex_)) {
    written_ = 0;
    writer_ = publisher_->create_datawriter(topic_, MakeWriterQos(depth_), this);
    if (writer_ == nullptr) throw NotCreated("writer", name_);
  }
  void Close() DISPERSA_PROVED(requires_capability(mutex_)) {
    writer_->set_listener(nullptr);
    publisher_->delete_datawriter(writer_);
  }

  std::string name_;
  dds::Topic* topic_;
  int depth_;
  dds::Publisher* publisher_;
  mutable Mutex mutex_;
  dds::DataWriter* writer_ DISPERSA_GUARDED_BY(mutex_) = nullptr;
  std::uint64_t written_ DISPERSA_GUARDED_BY(mutex_) = 0;
  std::uint64_t number_ DISPERSA_GUARDED_BY(mutex_) = 0;  ///< of the last seal
};

/// Hands over well-formed and valid samples (validity.h), on a thread of the middleware. The others are
/// refused with their sender.
template <typename PubSubType>
class Reader : private dds::DataReaderListener {
 public:
  using Message = typename PubSubType::type;
  using Plain = typename decltype(FromIdl(std::declval<const Message&>()))::value_type;
  using OnMessage = std::function<void(Plain&&, const std::string& sender)>;
  using OnGone = std::function<void(const std::string& sender)>;

  /// `on_gone`: a writer of this topic left, or its participant is gone.
  Reader(Participant& participant, dds::Subscriber* subscriber, const std::string& topic,
         OnMessage on_message, OnGone on_gone = {}, const dds::DataReaderQos& qos = MakeReaderQos("", 0))
      : topic_(topic),
        on_message_(std::move(on_message)),
        on_gone_(std::move(on_gone)),
        participant_(participant),
        subscriber_(subscriber) {
    reader_ = subscriber->create_datareader(participant.TopicOf<GuardedType<PubSubType>>(topic), qos, this);
    if (reader_ == nullptr) throw NotCreated("reader", topic);
  }
  ~Reader() override {
    reader_->set_listener(nullptr);
    subscriber_->delete_datareader(reader_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

 private:
  void on_data_available(dds::DataReader* reader) override {
    Message message;
    dds::SampleInfo info;
    // Two threads of the middleware come here one after the other: numbers of seals grow.
    const Lock lock(mutex_);
    while (reader->take_next_sample(&message, &info) == kDdsOk) {
      if (!info.valid_data) continue;
      using Type = GuardedType<PubSubType>;
      const std::string sender = ParticipantOf(info.publication_handle);
      if (participant_.IsSealed() &&
          (Type::is_foreign || !heard_.IsNew(info.publication_handle, Type::read))) {
        Complain(topic_, sender, "it does not show the secret that is wanted here");
        continue;
      }
      if (Type::refused) {
        Complain(topic_, sender, "it cannot be decoded");
        continue;
      }
      auto plain = FromIdl(message);
      std::string invalid = plain ? WhyInvalid(*plain) : "an unknown state or outcome";
      if (invalid.empty() && !participant_.MaySpeakFor(info.publication_handle, NameIn(*plain))) {
        invalid = "it names a worker or client that its keys are not for";
      }
      if (invalid.empty()) {
        on_message_(*std::move(plain), sender);
      } else {
        Complain(topic_, sender, invalid);
      }
    }
  }
  void on_subscription_matched(dds::DataReader*, const dds::SubscriptionMatchedStatus& status) override {
    if (status.current_count_change < 0 && on_gone_) {
      on_gone_(ParticipantOf(rtps::InstanceHandle_t(status.last_publication_handle)));
    }
  }
  void on_requested_incompatible_qos(dds::DataReader*,
                                     const dds::RequestedIncompatibleQosStatus& status) override {
    LogIncompatibleQos(topic_, status.last_policy_id);
  }

  std::string topic_;
  OnMessage on_message_;
  OnGone on_gone_;
  Participant& participant_;
  dds::Subscriber* subscriber_;
  dds::DataReader* reader_ = nullptr;
  Mutex mutex_;
  HeardSeals heard_ DISPERSA_GUARDED_BY(mutex_);
};

}  // namespace dispersa
