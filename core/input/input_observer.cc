#include "core/input/input_observer.h"

#include <cassert>

namespace dispersa {
namespace {

thread_local InputObserver* listener = nullptr;

}  // namespace

InputObserver* Listener() { return listener; }

Listening::Listening(InputObserver& observer) {
  assert(listener == nullptr);
  listener = &observer;
}

Listening::~Listening() { listener = nullptr; }

void SayKnows(const std::string& path, const std::vector<std::string>& keys) {
  if (listener != nullptr) listener->Knows(path, keys);
}

void SayHeeds(const std::string& path, const std::vector<std::string>& keys) {
  if (listener != nullptr) listener->Heeds(path, keys);
}

void SayMisses(const std::string& path, const std::vector<std::string>& keys) {
  if (listener != nullptr) listener->Misses(path, keys);
}

void SayExpects(const std::string& path, const Expectation& expectation) {
  if (listener != nullptr) listener->Expects(path, expectation);
}

}  // namespace dispersa
