#pragma once

// Named byte counters under one budget. Every large array and every GL object is charged to an account
// before it is made, so that too much is an error with a cure and not a crash.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace decalgl {

/// A handle to shared counters: copies count together. Safe to use from any thread.
class MemoryAccount {
public:
    /// `budget` in bytes; 0 sets no limit.
    explicit MemoryAccount(std::uint64_t budget = 0);

    /// Counts `bytes` under `name`. Throws Error(memory), with nothing counted, where the sum would pass the
    /// budget; the message says what was asked for, how much is in use, the budget and what to do.
    void add(const std::string& name, std::uint64_t bytes);
    /// Takes back what add() counted; never below zero.
    void remove(const std::string& name, std::uint64_t bytes) noexcept;

    std::uint64_t budget() const;
    void set_budget(std::uint64_t bytes);
    std::uint64_t total() const;
    std::uint64_t peak() const;
    std::uint64_t bytes(const std::string& name) const;

    /// The names that hold anything, in alphabetical order.
    std::vector<std::pair<std::string, std::uint64_t>> entries() const;

private:
    struct State;
    std::shared_ptr<State> state_;
};

/// Bytes counted for as long as this object lives.
class MemoryCharge {
public:
    MemoryCharge() = default;
    MemoryCharge(const MemoryAccount& account, std::string name, std::uint64_t bytes);
    MemoryCharge(MemoryCharge&& other) noexcept;
    MemoryCharge& operator=(MemoryCharge&& other) noexcept;
    MemoryCharge(const MemoryCharge&) = delete;
    MemoryCharge& operator=(const MemoryCharge&) = delete;
    ~MemoryCharge();

    std::uint64_t bytes() const { return bytes_; }

    /// Counts a new size in place of the old one; throws as MemoryAccount::add does, keeping the old one.
    void resize(std::uint64_t bytes);

private:
    void release() noexcept;

    std::shared_ptr<MemoryAccount> account_;
    std::string name_;
    std::uint64_t bytes_ = 0;
};

/// "1.5 MiB": bytes for people.
std::string format_bytes(std::uint64_t bytes);

}  // namespace decalgl
