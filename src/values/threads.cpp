#include "values/threads.hpp"

#include <exception>
#include <mutex>
#include <thread>

namespace surfmesh {

void run_by_threads(std::size_t threads, const std::function<void()>& work) {
    std::mutex one_at_a_time;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            work();
        } catch (...) {
            const std::lock_guard held(one_at_a_time);
            if (!failure) failure = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    others.reserve(threads - 1);
    try {
        while (others.size() + 1 < threads) others.emplace_back(run);
    } catch (const std::exception&) {
        // the system gives no more threads: those that there are do it all
    }
    run();
    for (std::thread& other : others) other.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace surfmesh
