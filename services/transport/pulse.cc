#include "services/transport/pulse.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <stop_token>
#include <thread>

#include "services/transport/admission.h"
#include "services/transport/endpoints.h"
#include "services/transport/topics.h"

namespace dispersa {
namespace {

/// Between two questions, and until one is repeated to the doors that have not answered.
constexpr std::chrono::seconds kQuestion(1);
/// A new door has this time to answer for the first time, while hundreds of workers join.
constexpr std::chrono::seconds kFirstAnswer(60);
constexpr char kThisMachine[] = "127.0.0.1";

}  // namespace

struct Pulse::Impl {
  explicit Impl(const NetworkOptions& network)
      : name(NameOnNetwork(network, MakeUuid())),
        participant(
            {network,
             "dispersa-pulse",
             std::nullopt,
             {{network.address.empty() ? kThisMachine : network.address, CoordinatorPort(network.domain)}}}),
        requests(participant, participant.MakePublisher(PartitionOf(name)), kRequestTopic, 1),
        replies(participant, participant.MakeSubscriber({PartitionOf(name)}), kReplyTopic,
                [this](Reply&& reply, const std::string& door) {
                  const Lock lock(mutex);
                  if (reply.number == number) answered.insert(door);
                }),
        thread([this](const std::stop_token& stop) { Ask(stop); }) {}

  // On a thread of its own, which may hang with the middleware.
  void Ask(const std::stop_token& stop) {
    std::mutex sleep;
    std::condition_variable_any woken;
    while (!stop.stop_requested()) {
      std::uint64_t question = 0;
      {
        const Lock lock(mutex);
        const std::size_t before = known.size();
        known.insert(answered.begin(), answered.end());
        const auto now = std::chrono::steady_clock::now();
        if (known.size() != before || known.size() >= static_cast<std::size_t>(doors)) grown = now;
        if (!known.empty() && answered.size() == known.size() && now - grown < kFirstAnswer) {
          ++beats;
          ++number;
          answered.clear();
        }
        question = number;
      }
      requests.Write(ToIdl(Request{name, question, "pulse", "{}", ""}));
      std::unique_lock lock(sleep);
      woken.wait_for(lock, stop, kQuestion, [] { return false; });
    }
  }

  std::string name;
  Mutex mutex;
  std::uint64_t number DISPERSA_GUARDED_BY(mutex) = 1;
  std::set<std::string> answered DISPERSA_GUARDED_BY(mutex);  ///< doors that have answered the question
  std::set<std::string> known DISPERSA_GUARDED_BY(mutex);     ///< those that ever have answered
  std::chrono::steady_clock::time_point grown DISPERSA_GUARDED_BY(mutex) = std::chrono::steady_clock::now();
  int doors DISPERSA_GUARDED_BY(mutex) = 0;
  std::atomic<long> beats = 0;
  Participant participant;
  Writer<idl::RequestV1PubSubType> requests;
  Reader<idl::ReplyV1PubSubType> replies;
  std::jthread thread;
};

Pulse::Pulse(const NetworkOptions& network) : impl_(std::make_unique<Impl>(network)) {}
Pulse::~Pulse() = default;

const std::string& Pulse::name() const { return impl_->name; }
ParticipantPrefix Pulse::prefix() const { return impl_->participant.prefix(); }
void Pulse::Expect(int doors) {
  const Lock lock(impl_->mutex);
  impl_->doors = doors;
}
long Pulse::beats() const { return impl_->beats; }

}  // namespace dispersa
