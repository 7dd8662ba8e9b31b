// Results on their way from a child process, which is the same program: values as their bytes.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/containment/contained.h"

namespace dispersa {

/// Values as they are, lists and texts behind their lengths.
class Packer {
 public:
  template <typename T>
  void Value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void Text(const std::string& text) {
    Value(text.size());
    bytes_ += text;
  }
  void Numbers(const std::vector<double>& numbers) {
    Value(numbers.size());
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
  }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads bytes that a plug-in may have spoilt: beyond the end there are zeros.
class Unpacker {
 public:
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}

  template <typename T>
  T Value() {
    T value{};
    std::memcpy(&value, Part(sizeof value), sizeof value);
    return value;
  }
  std::string Text() {
    const auto size = Value<std::size_t>();
    return {Part(size), is_whole_ ? size : 0};
  }
  std::vector<double> Numbers() {
    const auto count = Value<std::size_t>();
    const char* const part = Part(count > bytes_.size() ? bytes_.size() + 1 : count * sizeof(double));
    if (!is_whole_) return {};
    std::vector<double> numbers(count);
    std::memcpy(numbers.data(), part, count * sizeof(double));
    return numbers;
  }
  bool is_good() const { return is_whole_; }  ///< so far
  bool is_whole() const { return is_whole_ && at_ == bytes_.size(); }

 private:
  const char* Part(std::size_t size) {
    static constexpr char kNothing[256] = {};
    if (!is_whole_ || size > bytes_.size() - at_) {
      is_whole_ = false;
      return kNothing;
    }
    at_ += size;
    return bytes_.data() + at_ - size;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
  bool is_whole_ = true;
};

inline void Pack(const CaseResult& result, Packer& out) {
  out.Value(result.case_index);
  out.Value(result.outcome);
  out.Value(result.end_time_s);
  out.Value(result.end_stage);
  out.Text(result.reason);
  out.Numbers(result.inputs);
  out.Value(result.inputs_digest);
  out.Numbers(result.metrics);
  out.Value(result.digest);
  out.Value(result.events.size());
  for (const SeenEvent& event : result.events) {
    out.Text(event.name);
    for (const auto value : SeenEvent::kValues) out.Value(event.*value);
  }
}

inline CaseResult UnpackResult(Unpacker& in) {
  CaseResult result;
  result.case_index = in.Value<std::uint64_t>();
  result.outcome = in.Value<Outcome>();
  result.end_time_s = in.Value<double>();
  result.end_stage = in.Value<int>();
  result.reason = in.Text();
  result.inputs = in.Numbers();
  result.inputs_digest = in.Value<Digest>();
  result.metrics = in.Numbers();
  result.digest = in.Value<Digest>();
  const auto events = in.Value<std::size_t>();
  while (in.is_good() && result.events.size() < events) {
    SeenEvent& event = result.events.emplace_back();
    event.name = in.Text();
    for (const auto value : SeenEvent::kValues) event.*value = in.Value<double>();
  }
  return result;
}

/// Thrown if the bytes are no result.
inline ContainedEnd Garbled() { return {"returned no valid result", PluginMark{}}; }

}  // namespace dispersa
