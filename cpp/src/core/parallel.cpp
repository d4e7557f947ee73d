#include "decalgl/core/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace decalgl {
namespace {

unsigned affinity_count() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof(set), &set) == 0) {
        return static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
    }
    return std::max(1U, std::thread::hardware_concurrency());
}

/// The blocks of one call, handed out in order, and the first exception of any of them.
class Blocks {
public:
    Blocks(std::size_t count, std::size_t grain, const RangeFn& body)
        : count_(count), grain_(grain), blocks_(block_count(count, grain)), body_(body) {}

    void work() noexcept {
        while (run_next()) {
        }
    }

    void work_and_report(const ShareFn& report) noexcept {
        do {
            const std::size_t begun = next_.load();
            if (begun >= blocks_ || failed_.load()) {
                return;
            }
            try {
                report(static_cast<double>(begun) / static_cast<double>(blocks_));
            } catch (...) {
                fail(std::current_exception());
            }
        } while (run_next());
    }

    void rethrow() const {
        if (error_) {
            std::rethrow_exception(error_);
        }
    }

private:
    bool run_next() noexcept {
        const std::size_t block = failed_.load() ? blocks_ : next_.fetch_add(1);
        if (block >= blocks_) {
            return false;
        }
        try {
            const std::size_t begin = block * grain_;
            body_(begin, begin + std::min(grain_, count_ - begin));
        } catch (...) {
            fail(std::current_exception());
        }
        return true;
    }

    void fail(std::exception_ptr error) noexcept {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!error_) {
            error_ = std::move(error);
        }
        failed_.store(true);
    }

    std::size_t count_;
    std::size_t grain_;
    std::size_t blocks_;
    const RangeFn& body_;
    std::atomic<std::size_t> next_{0};
    std::atomic<bool> failed_{false};
    std::mutex mutex_;
    std::exception_ptr error_;
};

}  // namespace

unsigned hardware_threads() {
    if (const char* wanted = std::getenv("DECALGL_THREADS")) {
        const long threads = std::strtol(wanted, nullptr, 10);
        if (threads > 0) {
            return static_cast<unsigned>(std::min(threads, 1024L));
        }
    }
    return affinity_count();
}

void parallel_for(std::size_t count, std::size_t grain, unsigned threads, const RangeFn& body,
                  const ShareFn& report) {
    if (count == 0) {
        return;
    }
    const std::size_t step = std::max<std::size_t>(grain, 1);
    const unsigned wanted = threads == 0 ? hardware_threads() : threads;
    const std::size_t helpers = std::min<std::size_t>(wanted, block_count(count, step)) - 1;

    Blocks blocks(count, step, body);
    std::vector<std::thread> team;
    team.reserve(helpers);
    for (std::size_t helper = 0; helper < helpers; ++helper) {
        try {
            team.emplace_back([&blocks] { blocks.work(); });
        } catch (const std::exception&) {
            break;  // The system has no more threads to give: those there are do all of it.
        }
    }
    if (report) {
        blocks.work_and_report(report);
    } else {
        blocks.work();
    }
    for (std::thread& thread : team) {
        thread.join();
    }
    blocks.rethrow();
    if (report) {
        report(1.0);  // Here, since the helpers may have taken every block after the first report.
    }
}

}  // namespace decalgl
