// Contexts: each backend, several at once, what happens to objects of a context that is gone, and errors.

#include "gl_fixture.h"

#include "gl/buffer.h"
#include "gl/context_state.h"
#include "gl/gl.h"
#include "gl/program.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

using namespace decalgl;
using namespace decalgl::gl;

namespace {

/// Writes and reads a buffer, which tells whether the functions reach the context they should.
bool round_trip() {
    const MemoryAccount account;
    const std::vector<int> values{1, 2, 3};
    return Buffer::from(account, "values", values).read<int>() == values;
}

bool is_available(Backend backend) {
    for (const Probe& probe : probe_backends()) {
        if (probe.ok && probe.info.backend == backend) {
            return true;
        }
    }
    return false;
}

}  // namespace

TEST_CASE("the context is OpenGL 4.5 or later, on the driver that is expected") {
    const ContextInfo& info = test::test_context().info();
    CHECK(info.major * 10 + info.minor >= 45);
    CHECK(!info.platform.empty());
    CHECK(info.max_texture_size >= 16384);
    CHECK(info.max_texture_buffer_size >= 65536);
    CHECK(info.max_viewport[0] >= 16384);
    CHECK(info.max_samples >= 4);
    // Where the variable is set, a silent change of driver is a failure.
    if (const char* expected = std::getenv("DECALGL_EXPECT_RENDERER")) {
        CHECK_THAT(info.renderer, Catch::Contains(expected));
    }
}

TEST_CASE("each backend that is there draws, alone and in turn") {
    test::test_context().release();
    std::vector<Backend> backends;
    for (const Backend backend : {Backend::egl, Backend::osmesa}) {
        if (is_available(backend)) {
            backends.push_back(backend);
        }
    }
    REQUIRE(!backends.empty());

    std::vector<std::unique_ptr<Context>> contexts;
    for (int copy = 0; copy < 2; ++copy) {
        for (const Backend backend : backends) {
            contexts.push_back(Context::create(backend, true));
            CHECK(contexts.back()->info().backend == backend);
            CHECK(Context::current() == contexts.back().get());
        }
    }
    for (int turn = 0; turn < 2; ++turn) {
        for (const auto& context : contexts) {
            context->make_current();
            CHECK(round_trip());
        }
    }
}

TEST_CASE("every probe says what it found or how to cure it") {
    Context& before = test::test_context();
    const std::vector<Probe> probes = probe_backends();
    CHECK(probes.size() >= 2);
    for (const Probe& probe : probes) {
        CHECK(!probe.name.empty());
        CHECK(!probe.detail.empty());
        CHECK(probe.cure.empty() == probe.ok);
    }
    CHECK(Context::current() == &before);
    CHECK(round_trip());
}

TEST_CASE("objects may be dropped after their context, or while it is not current") {
    const MemoryAccount account;
    Buffer orphan;
    {
        const auto context = Context::create(Backend::automatic, true);
        orphan = Buffer::create(account, "orphan", 64);
    }
    CHECK(account.bytes("orphan") == 64);
    orphan = Buffer();
    CHECK(account.bytes("orphan") == 0);

    const auto first = Context::create(Backend::automatic, true);
    Buffer late = Buffer::create(account, "late", 64);
    const GLuint name = late.id();
    {
        const auto second = Context::create(Backend::automatic, true);
        const Buffer same_name = Buffer::create(account, "same", 64);
        CHECK(same_name.id() == name);
        late = Buffer();
        CHECK(glIsBuffer(name) == GL_TRUE);  // that of the second context
    }
    first->make_current();
    CHECK(glIsBuffer(name) == GL_FALSE);
}

TEST_CASE("a scope puts back the context that was current before") {
    Context& outer = test::test_context();
    const auto inner = Context::create(Backend::automatic, true);
    outer.make_current();
    {
        const CurrentScope scope(*inner);
        CHECK(Context::current() == inner.get());
        const CurrentScope again(*inner);
        CHECK(Context::current() == inner.get());
    }
    CHECK(Context::current() == &outer);
    outer.release();
    { const CurrentScope scope(*inner); }
    CHECK(Context::current() == nullptr);
}

TEST_CASE("threads draw with contexts of their own, and never with one in use elsewhere") {
    Context& here = test::test_context();
    bool refused = false;
    bool drew = false;
    std::unique_ptr<Context> theirs;
    std::thread thread([&] {
        try {
            here.make_current();
        } catch (const Error& error) {
            refused = error.kind() == ErrorKind::graphics;
        }
        theirs = Context::create(here.info().backend, true);
        drew = round_trip();
    });
    thread.join();
    CHECK(refused);
    CHECK(drew);
    theirs->make_current();  // left by the thread that ended
    CHECK(round_trip());
}

TEST_CASE("errors of the driver become exceptions at the next check") {
    test::test_context();
    glBindBufferBase(GL_UNIFORM_BUFFER, 1000000, 0);
    try {
        check_errors("binding too far");
        FAIL("nothing was thrown");
    } catch (const Error& error) {
        CHECK(error.kind() == ErrorKind::graphics);
        CHECK_THAT(error.what(), Catch::Contains("binding too far") && Catch::Contains("GL_INVALID_VALUE"));
    }
    check_errors("after the error was told");
}

TEST_CASE("a recycled context comes back with its programs, and what has failed does not") {
    test::test_context().release();
    std::unique_ptr<Context> context = Context::acquire(Backend::automatic);
    const Context* const first = context.get();
    const GLuint program = context->programs().get("floor", {}).id();
    Context::recycle(std::move(context));
    CHECK(Context::current() == nullptr);
    context = Context::acquire(Backend::automatic);
    CHECK(context.get() == first);
    CHECK(Context::current() == first);
    CHECK(context->programs().get("floor", {}).id() == program);

    const std::unique_ptr<Context> other = Context::acquire(Backend::automatic);
    CHECK(other.get() != first);
    context->make_current();
    glBindBufferBase(GL_UNIFORM_BUFFER, 1000000, 0);
    other->make_current();
    const std::weak_ptr<ContextState> failed = context->state();
    Context::recycle(std::move(context));
    CHECK(Context::current() == other.get());
    CHECK(failed.expired());
}

TEST_CASE("without a current context, objects are refused with an error") {
    test::test_context().release();
    const MemoryAccount account;
    CHECK_THROWS_AS(TextureBuffer::create(account, "cells", GL_R32F, 4), Error);
    CHECK_THROWS_AS(Buffer::create(account, "cells", 4), Error);
    CHECK(account.total() == 0);
}
