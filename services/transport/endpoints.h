// Readers and writers with the quality of service of all our topics (README.md). Internal to this folder.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "services/transport/participant.h"

namespace dispersa {

using WriterHandle = eprosima::fastrtps::rtps::InstanceHandle_t;

enum class Presence {
  kNone,       ///< ordinary data
  kHeartbeat,  ///< the writer must assert itself (Beat) within the lease, and only its newest sample matters
};

inline constexpr int kHeartbeatLeaseSeconds = 3;

eprosima::fastdds::dds::DataWriterQos MakeWriterQos(Presence presence);
eprosima::fastdds::dds::DataReaderQos MakeReaderQos(Presence presence);

/// Reports a mismatch of quality of service, which would otherwise be silent.
void LogIncompatibleQos(const std::string& topic, eprosima::fastdds::dds::QosPolicyId_t policy);

/// Thread-safe.
template <typename PubSubType>
class Writer : private eprosima::fastdds::dds::DataWriterListener {
 public:
  using Message = typename PubSubType::type;

  /// `on_matched` is told the change of the number of matched readers, on a thread of the middleware.
  Writer(Participant& participant, eprosima::fastdds::dds::Publisher* publisher, const std::string& topic,
         Presence presence = Presence::kNone, std::function<void(int)> on_matched = {})
      : topic_(topic), on_matched_(std::move(on_matched)), publisher_(publisher) {
    writer_ =
        publisher->create_datawriter(participant.TopicOf<PubSubType>(topic), MakeWriterQos(presence), this);
    if (writer_ == nullptr) throw NetworkError("cannot create a writer of " + topic);
  }
  ~Writer() override {
    writer_->set_listener(nullptr);
    publisher_->delete_datawriter(writer_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// False: not now, the same again later.
  bool Write(Message message) {
    const std::lock_guard lock(mutex_);
    // A history that keeps all would grow for as long as the process lives. What every reader has
    // acknowledged has served its purpose; a reader that is not there yet gets what came since.
    if (++written_since_clear_ >= 4096 && matched() > 0 &&
        writer_->wait_for_acknowledgments({0, 1}) == ReturnCode_t::RETCODE_OK) {
      std::size_t removed = 0;
      writer_->clear_history(&removed);
      written_since_clear_ = 0;
    }
    return writer_->write(&message);
  }
  void Beat() { writer_->assert_liveliness(); }
  int matched() const {
    eprosima::fastdds::dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }
  /// Waits until what was written has arrived.
  void Drain(int milliseconds) {
    writer_->wait_for_acknowledgments(
        {milliseconds / 1000, static_cast<unsigned>(milliseconds % 1000) * 1000000u});
  }

 private:
  void on_publication_matched(eprosima::fastdds::dds::DataWriter*,
                              const eprosima::fastdds::dds::PublicationMatchedStatus& status) override {
    if (on_matched_) on_matched_(status.current_count_change);
  }
  void on_offered_incompatible_qos(
      eprosima::fastdds::dds::DataWriter*,
      const eprosima::fastdds::dds::OfferedIncompatibleQosStatus& status) override {
    LogIncompatibleQos(topic_, status.last_policy_id);
  }

  std::string topic_;
  std::function<void(int)> on_matched_;
  eprosima::fastdds::dds::Publisher* publisher_;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  std::mutex mutex_;
  std::size_t written_since_clear_ = 0;
};

/// What a reader tells, on threads of the middleware.
template <typename Message>
struct ReaderCallbacks {
  std::function<void(const Message&, const WriterHandle& from)> on_message;
  std::function<void(const WriterHandle&)> on_silent = {};     ///< its heartbeat stopped
  std::function<void(const WriterHandle&)> on_unmatched = {};  ///< it left, or its participant is gone
};

template <typename PubSubType>
class Reader : private eprosima::fastdds::dds::DataReaderListener {
 public:
  using Message = typename PubSubType::type;

  Reader(Participant& participant, eprosima::fastdds::dds::Subscriber* subscriber, const std::string& topic,
         ReaderCallbacks<Message> callbacks, Presence presence = Presence::kNone)
      : topic_(topic), callbacks_(std::move(callbacks)), subscriber_(subscriber) {
    reader_ =
        subscriber->create_datareader(participant.TopicOf<PubSubType>(topic), MakeReaderQos(presence), this);
    if (reader_ == nullptr) throw NetworkError("cannot create a reader of " + topic);
  }
  ~Reader() override {
    reader_->set_listener(nullptr);
    subscriber_->delete_datareader(reader_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

 private:
  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
    Message message;
    eprosima::fastdds::dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) callbacks_.on_message(message, info.publication_handle);
    }
  }
  void on_subscription_matched(eprosima::fastdds::dds::DataReader*,
                               const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override {
    if (status.current_count_change < 0 && callbacks_.on_unmatched) {
      callbacks_.on_unmatched(status.last_publication_handle);
    }
  }
  void on_liveliness_changed(eprosima::fastdds::dds::DataReader*,
                             const eprosima::fastrtps::LivelinessChangedStatus& status) override {
    if (status.not_alive_count_change > 0 && callbacks_.on_silent) {
      callbacks_.on_silent(status.last_publication_handle);
    }
  }
  void on_requested_incompatible_qos(
      eprosima::fastdds::dds::DataReader*,
      const eprosima::fastdds::dds::RequestedIncompatibleQosStatus& status) override {
    LogIncompatibleQos(topic_, status.last_policy_id);
  }

  std::string topic_;
  ReaderCallbacks<Message> callbacks_;
  eprosima::fastdds::dds::Subscriber* subscriber_;
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
};

}  // namespace dispersa
