#include "gl/context.h"

#include "decalgl/core/error.h"
#include "gl/backends.h"
#include "gl/context_info.h"
#include "gl/context_state.h"
#include "gl/gl.h"
#include "gl/program.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <mutex>
#include <utility>

#include <fmt/format.h>

namespace decalgl::gl {
namespace {

/// Which backend the process-wide table of functions serves, and how many contexts use it now.
struct FunctionTable {
    std::mutex mutex;
    Backend backend = Backend::automatic;
    int users = 0;
};

FunctionTable& function_table() {
    static FunctionTable table;
    return table;
}

void stop_using_table(ContextState& state) noexcept {
    if (state.current.exchange(false)) {
        const std::lock_guard<std::mutex> lock(function_table().mutex);
        --function_table().users;
    }
}

/// What a thread has current. A thread that ends leaves its context to the others.
struct ThreadSlot {
    std::shared_ptr<ContextState> state;  ///< outlives the context, which may be gone

    ~ThreadSlot() {
        if (state != nullptr && state->context != nullptr) {
            state->context->release();
        }
    }
};

std::shared_ptr<ContextState>& thread_state() {
    thread_local ThreadSlot slot;
    return slot.state;
}

bool debug_from_environment() {
    const char* value = std::getenv("DECALGL_GL_DEBUG");
    return value != nullptr && std::strcmp(value, "0") != 0 && *value != '\0';
}

/// Called by the driver: may only take notes, since exceptions must not cross its C frames. What the shader
/// compiler says is left out: it reaches the caller through the compile and link status, and a note of it
/// would be blamed on whatever is checked next.
void GLAD_API_PTR on_debug_message(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei,
                                   const GLchar* message, const void* user) {
    const bool is_error = type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH;
    if (!is_error || source == GL_DEBUG_SOURCE_SHADER_COMPILER) {
        return;
    }
    auto* state = const_cast<ContextState*>(static_cast<const ContextState*>(user));
    try {
        const std::lock_guard<std::mutex> lock(state->mutex);
        if (state->messages.size() < 16) {
            state->messages.emplace_back(message);
        }
    } catch (...) {
        // Without memory for the note, glGetError still tells that something went wrong.
    }
}

std::vector<Platform> platforms_of(Backend backend) {
    std::vector<Platform> platforms;
    if (backend != Backend::osmesa) {
        platforms = egl_platforms();
    }
    if (backend != Backend::egl) {
        for (Platform& platform : osmesa_platforms()) {
            platforms.push_back(std::move(platform));
        }
    }
    return platforms;
}

constexpr std::size_t most_idle_contexts = 4;

struct IdleContexts {
    std::mutex mutex;
    std::vector<std::unique_ptr<Context>> contexts;
};

/// Never destroyed: at the end of the process drivers may be gone before it would be.
IdleContexts& idle_contexts() {
    static auto* const idle = new IdleContexts;
    return *idle;
}

}  // namespace

std::unique_ptr<Context> open_platform(const Platform& platform, bool debug) {
    std::unique_ptr<Context> context = platform.open(debug);
    context->set_up(platform.name, debug);
    return context;
}

const char* to_string(Backend backend) {
    switch (backend) {
        case Backend::automatic:
            return "auto";
        case Backend::egl:
            return "egl";
        case Backend::osmesa:
            return "osmesa";
    }
    return "unknown";
}

Context::Context() : state_(std::make_shared<ContextState>()), programs_(std::make_unique<ProgramCache>()) {
    state_->context = this;
}

Context::~Context() = default;

std::unique_ptr<Context> Context::create(Backend backend, bool debug) {
    const bool with_debug = debug || debug_from_environment();
    std::string attempts;
    for (const Platform& platform : platforms_of(backend)) {
        try {
            return open_platform(platform, with_debug);
        } catch (const Error& error) {
            attempts += fmt::format("\n  {}: {}", platform.name, error.what());
        }
    }
    throw Error(
        ErrorKind::graphics,
        "No OpenGL 4.5 context could be opened, so nothing can be drawn. Tried:" + attempts +
            "\nOn Debian and Ubuntu, `apt-get install libegl1 libgl1-mesa-dri` brings a software renderer "
            "that needs no graphics card (or `apt-get install libosmesa6`). `decalgl doctor` shows more.");
}

std::unique_ptr<Context> Context::acquire(Backend backend) {
    std::unique_ptr<Context> context;
    {
        const std::lock_guard<std::mutex> lock(idle_contexts().mutex);
        auto& idle = idle_contexts().contexts;
        // The last one first: what follows each other often wants the same programs.
        const auto found = std::find_if(idle.rbegin(), idle.rend(), [&](const auto& one) {
            return one->wanted_ == backend && one->state_->debug == debug_from_environment();
        });
        if (found != idle.rend()) {
            context = std::move(*found);
            idle.erase(std::next(found).base());
        }
    }
    if (context == nullptr) {
        context = create(backend);
        context->wanted_ = backend;
        return context;
    }
    context->uploads_ = {};
    context->make_current();
    return context;
}

void Context::recycle(std::unique_ptr<Context> context) noexcept {
    try {
        {
            const CurrentScope current(*context);
            check_errors("finishing");
        }
        context->release();
        const std::lock_guard<std::mutex> lock(idle_contexts().mutex);
        if (idle_contexts().contexts.size() < most_idle_contexts) {
            idle_contexts().contexts.push_back(std::move(context));
        }
    } catch (...) {
        // What has failed is closed.
    }
}

void Context::set_up(const std::string& platform, bool debug) {
    state_->debug = debug;
    make_current();
    try {
        info_ = read_context_info(backend(), platform);
        if (debug) {
            glEnable(GL_DEBUG_OUTPUT);
            glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
            glDebugMessageCallback(on_debug_message, state_.get());
        }
        check_errors("setting up the context");
    } catch (...) {
        release();
        throw;
    }
}

void Context::make_current() {
    if (current() == this) {
        bind();  // Another library may have changed the driver's mind in the meantime.
        delete_dropped();
        return;
    }
    leave_previous();
    claim_function_table();
    try {
        bind();
        load_functions();
    } catch (...) {
        unbind();
        stop_using_table(*state_);
        throw;
    }
    thread_state() = state_;
    delete_dropped();
}

void Context::delete_dropped() {
    std::vector<std::pair<ObjectType, GLuint>> dropped;
    {
        const std::lock_guard<std::mutex> lock(state_->mutex);
        dropped.swap(state_->dropped);
    }
    for (const auto& [type, name] : dropped) {
        delete_object(type, name);
    }
}

/// Mesa's EGL and OSMesa share their notion of the current context without telling each other: the old one
/// is left before the new one is entered.
void Context::leave_previous() {
    if (Context* previous = current()) {
        previous->release();
    }
}

void Context::claim_function_table() {
    FunctionTable& table = function_table();
    const std::lock_guard<std::mutex> lock(table.mutex);
    if (table.users > 0 && table.backend != backend()) {
        throw Error(ErrorKind::graphics,
                    fmt::format("{} contexts are in use on other threads, and {} cannot run "
                                "beside them. Use one backend for all renderers.",
                                to_string(table.backend), to_string(backend())));
    }
    if (state_->current.exchange(true)) {
        throw Error(
            ErrorKind::graphics,
            "This OpenGL context is in use on another thread. Use one renderer per thread, or finish the "
            "work on the other thread first.");
    }
    ++table.users;
}

void Context::load_functions() {
    FunctionTable& table = function_table();
    const std::lock_guard<std::mutex> lock(table.mutex);
    if (table.backend == backend()) {
        return;
    }
    const auto load = [](void* user, const char* name) {
        return reinterpret_cast<GLADapiproc>(static_cast<const Context*>(user)->get_proc(name));
    };
    if (gladLoadGLUserPtr(load, this) == 0) {
        table.backend = Backend::automatic;
        throw Error(ErrorKind::graphics, "The driver does not give its OpenGL functions.");
    }
    table.backend = backend();
}

void Context::release() noexcept {
    if (current() != this) {
        return;
    }
    const std::shared_ptr<ContextState> keep = std::move(thread_state());
    thread_state().reset();
    unbind();
    stop_using_table(*state_);
}

void Context::shut_down() noexcept {
    if (current() == this) {
        thread_state().reset();
        unbind();
    }
    stop_using_table(*state_);
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->context = nullptr;
    state_->dropped.clear();
}

Context* Context::current() {
    const std::shared_ptr<ContextState>& state = thread_state();
    return state == nullptr ? nullptr : state->context;
}

Context& Context::require_current() {
    Context* context = current();
    if (context == nullptr) {
        throw Error(ErrorKind::graphics, "There is no current OpenGL context on this thread.");
    }
    return *context;
}

CurrentScope::CurrentScope(Context& context) : context_(&context), previous_(Context::current()) {
    if (previous_ != context_) {
        context_->make_current();
    }
}

CurrentScope::~CurrentScope() {
    if (previous_ == context_) {
        return;
    }
    try {
        context_->release();
        if (previous_ != nullptr) {
            previous_->make_current();
        }
    } catch (...) {
        // The next make_current() says what is wrong.
    }
}

std::vector<Probe> probe_backends() {
    Context* previous = Context::current();
    std::vector<Probe> probes;
    for (const Platform& platform : platforms_of(Backend::automatic)) {
        Probe probe;
        probe.name = platform.name;
        try {
            probe.info = open_platform(platform, false)->info();
            probe.ok = true;
            probe.detail =
                fmt::format("OpenGL {}.{}, {}", probe.info.major, probe.info.minor, probe.info.renderer);
        } catch (const Error& error) {
            probe.detail = error.what();
            probe.cure = platform.cure;
        }
        probes.push_back(std::move(probe));
    }
    if (previous != nullptr) {
        previous->make_current();
    }
    return probes;
}

void check_errors(const char* where) {
    const std::shared_ptr<ContextState>& state = Context::require_current().state();
    std::vector<std::string> messages;
    {
        const std::lock_guard<std::mutex> lock(state->mutex);
        messages.swap(state->messages);
    }
    bool out_of_memory = false;
    // Bounded, since a lost context may report errors for ever.
    for (int count = 0; count < 32; ++count) {
        const GLenum code = glGetError();
        if (code == GL_NO_ERROR) {
            break;
        }
        out_of_memory = out_of_memory || code == GL_OUT_OF_MEMORY;
        messages.emplace_back(error_name(code));
    }
    if (messages.empty()) {
        return;
    }
    if (out_of_memory) {
        throw Error(ErrorKind::memory,
                    fmt::format("OpenGL ran out of memory while {}. Make a smaller picture or "
                                "draw fewer features.",
                                where));
    }
    throw Error(ErrorKind::graphics,
                fmt::format("OpenGL reported an error while {}: {}", where, fmt::join(messages, "; ")));
}

}  // namespace decalgl::gl
