// The state of each case of a campaign and the fingerprint of its result, in little memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/flight/digest.h"
#include "core/math/assertion.h"

namespace dispersa {

enum class CaseState : std::uint8_t { kWaiting, kSuspect, kAssigned, kDone, kQuarantined };

/// Cases 0 .. size() - 1. Every case waits at first. A block of 4096 cases takes memory, 17 bytes a case,
/// when the first of them leaves that state.
class CaseTable {
 public:
  explicit CaseTable(std::uint64_t size) { Extend(size); }

  std::uint64_t size() const { return size_; }
  /// Adds cases at the end.
  void Extend(std::uint64_t size) {
    DISPERSA_ASSERT(size >= size_, size, size_);
    blocks_.resize((size + kBlock - 1) / kBlock);
    size_ = size;
  }
  CaseState StateOf(std::uint64_t index) const {
    DISPERSA_ASSERT(index < size_, index, size_);
    const auto& block = blocks_[index / kBlock];
    return block ? block->states[index % kBlock] : CaseState::kWaiting;
  }
  /// The fingerprint of a case that is done.
  Digest FingerprintOf(std::uint64_t index) const {
    DISPERSA_ASSERT(index < size_, index, size_);
    const auto& block = blocks_[index / kBlock];
    return block ? block->fingerprints[index % kBlock] : Digest();
  }
  void Set(std::uint64_t index, CaseState state) { Touch(index).states[index % kBlock] = state; }
  void SetDone(std::uint64_t index, const Digest& fingerprint) {
    Block& block = Touch(index);
    block.states[index % kBlock] = CaseState::kDone;
    block.fingerprints[index % kBlock] = fingerprint;
  }

 private:
  static constexpr std::size_t kBlock = 4096;
  struct Block {
    std::array<Digest, kBlock> fingerprints{};
    std::array<CaseState, kBlock> states{};
  };

  Block& Touch(std::uint64_t index) {
    DISPERSA_ASSERT(index < size_, index, size_);
    auto& block = blocks_[index / kBlock];
    if (!block) block = std::make_unique<Block>();
    return *block;
  }

  std::vector<std::unique_ptr<Block>> blocks_;  ///< none: all of its cases wait
  std::uint64_t size_ = 0;
};

}  // namespace dispersa
