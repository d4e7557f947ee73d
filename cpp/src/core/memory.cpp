#include "decalgl/core/memory.h"

#include "decalgl/core/error.h"

#include <algorithm>
#include <map>
#include <mutex>

#include <fmt/format.h>

namespace decalgl {

struct MemoryAccount::State {
    std::mutex mutex;
    std::map<std::string, std::uint64_t> counters;
    std::uint64_t budget = 0;
    std::uint64_t total = 0;
    std::uint64_t peak = 0;
};

MemoryAccount::MemoryAccount(std::uint64_t budget) : state_(std::make_shared<State>()) {
    state_->budget = budget;
}

void MemoryAccount::add(const std::string& name, std::uint64_t bytes) {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    // Compared by subtraction, since the sum of two absurd sizes may wrap around.
    const std::uint64_t room = state_->budget > state_->total ? state_->budget - state_->total : 0;
    if (state_->budget != 0 && bytes > room) {
        throw Error(
            ErrorKind::memory,
            fmt::format("{} needs {}, but {} of the memory limit of {} are in use. Raise memory_limit, "
                        "draw fewer features or make a smaller picture.",
                        name, format_bytes(bytes), format_bytes(state_->total),
                        format_bytes(state_->budget)));
    }
    if (bytes > UINT64_MAX - state_->total) {
        throw Error(ErrorKind::memory,
                    fmt::format("{} asks for {} bytes, more than can be counted.", name, bytes));
    }
    state_->counters[name] += bytes;
    state_->total += bytes;
    state_->peak = std::max(state_->peak, state_->total);
}

void MemoryAccount::remove(const std::string& name, std::uint64_t bytes) noexcept {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    const auto counter = state_->counters.find(name);
    if (counter == state_->counters.end()) {
        return;
    }
    const std::uint64_t taken = std::min(bytes, counter->second);
    counter->second -= taken;
    state_->total -= taken;
    if (counter->second == 0) {
        state_->counters.erase(counter);
    }
}

std::uint64_t MemoryAccount::budget() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return state_->budget;
}

void MemoryAccount::set_budget(std::uint64_t bytes) {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->budget = bytes;
}

std::uint64_t MemoryAccount::total() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return state_->total;
}

std::uint64_t MemoryAccount::peak() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return state_->peak;
}

std::uint64_t MemoryAccount::bytes(const std::string& name) const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    const auto counter = state_->counters.find(name);
    return counter == state_->counters.end() ? 0 : counter->second;
}

std::vector<std::pair<std::string, std::uint64_t>> MemoryAccount::entries() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return {state_->counters.begin(), state_->counters.end()};
}

MemoryCharge::MemoryCharge(const MemoryAccount& account, std::string name, std::uint64_t bytes)
    : account_(std::make_shared<MemoryAccount>(account)), name_(std::move(name)) {
    account_->add(name_, bytes);
    bytes_ = bytes;
}

MemoryCharge::MemoryCharge(MemoryCharge&& other) noexcept
    : account_(std::move(other.account_)),
      name_(std::move(other.name_)),
      bytes_(std::exchange(other.bytes_, 0)) {}

MemoryCharge& MemoryCharge::operator=(MemoryCharge&& other) noexcept {
    if (this != &other) {
        release();
        account_ = std::move(other.account_);
        name_ = std::move(other.name_);
        bytes_ = std::exchange(other.bytes_, 0);
    }
    return *this;
}

MemoryCharge::~MemoryCharge() {
    release();
}

void MemoryCharge::resize(std::uint64_t bytes) {
    if (account_ == nullptr) {
        return;
    }
    if (bytes > bytes_) {
        account_->add(name_, bytes - bytes_);
    } else {
        account_->remove(name_, bytes_ - bytes);
    }
    bytes_ = bytes;
}

void MemoryCharge::release() noexcept {
    if (account_ != nullptr) {
        account_->remove(name_, bytes_);
        account_.reset();
        bytes_ = 0;
    }
}

std::string format_bytes(std::uint64_t bytes) {
    const char* const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    if (bytes < 1024) {
        return fmt::format("{} bytes", bytes);
    }
    double value = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (value >= 1024.0 && unit + 1 < sizeof(units) / sizeof(units[0])) {
        value /= 1024.0;
        ++unit;
    }
    return fmt::format("{:.1f} {}", value, units[unit]);
}

}  // namespace decalgl
