#pragma once

// Headless OpenGL contexts: EGL first, OSMesa second, both opened at run time.
//
// Threads: a context is current on one thread at a time, and everything in gl/ is called on that thread.
// Contexts of the same backend may be current on several threads at once. The table of GL functions belongs
// to the process, so contexts of different backends may not be current at the same time.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace decalgl::gl {

enum class Backend { automatic, egl, osmesa };

const char* to_string(Backend backend);

/// What a context can do, read once when it is made.
struct ContextInfo {
    Backend backend = Backend::automatic;
    std::string platform;  ///< "EGL device 0", "EGL surfaceless Mesa", "OSMesa"
    std::string vendor;
    std::string renderer;
    std::string version;
    std::string glsl;
    int major = 0;
    int minor = 0;
    bool software = false;
    int max_texture_size = 0;
    int max_array_texture_layers = 0;
    int max_texture_buffer_size = 0;  ///< texels
    int max_renderbuffer_size = 0;
    int max_viewport[2] = {0, 0};
    int max_samples = 0;
    int max_uniform_block_bytes = 0;
    long long max_storage_block_bytes = 0;
    std::vector<std::string> missing_features;  ///< of OpenGL 4.6, that this driver does not have
};

/// What was handed to the driver in buffers and textures.
struct Uploads {
    std::uint64_t count = 0;
    std::uint64_t bytes = 0;

    void add(std::uint64_t more) {
        ++count;
        bytes += more;
    }
};

struct Platform;
class ProgramCache;

/// Remembers which context an object belongs to, and outlives it.
struct ContextState;

class Context {
public:
    /// Opens a context of OpenGL 4.5 or later (4.6 is asked for first) and leaves it current on this thread.
    /// `debug` (or DECALGL_GL_DEBUG=1) makes the driver's errors exceptions at the next check_errors().
    /// Throws Error(graphics) that lists every attempt, why it failed and the packages to install.
    static std::unique_ptr<Context> create(Backend backend = Backend::automatic, bool debug = false);

    /// One that was recycled, else a new one.
    static std::unique_ptr<Context> acquire(Backend backend);
    /// Keeps a context, with the programs that it has compiled, for the next one who wants the like: linking them again
    /// would take longer than many a picture. One that has failed, or is one too many, is closed.
    static void recycle(std::unique_ptr<Context> context) noexcept;

    virtual ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes this context current on the calling thread and loads the GL functions where the backend changed.
    /// Objects whose handles were dropped elsewhere in the meantime are deleted now.
    void make_current();
    /// Leaves the calling thread without a context, if this one was current there.
    void release() noexcept;

    const ContextInfo& info() const { return info_; }
    ProgramCache& programs() { return *programs_; }
    /// Counted by buffers and textures; whoever wants to know sets it to zero before.
    Uploads& uploads() { return uploads_; }

    /// The context that make_current() last left on this thread, or null.
    static Context* current();
    /// The current context; Error(graphics) where there is none.
    static Context& require_current();

    const std::shared_ptr<ContextState>& state() const { return state_; }

protected:
    Context();

    /// Must be called by every backend's destructor while its driver objects still exist.
    void shut_down() noexcept;

    virtual void bind() = 0;
    virtual void unbind() noexcept = 0;
    virtual void* get_proc(const char* name) const = 0;
    virtual Backend backend() const = 0;

private:
    /// The first make_current(), checks and reads info().
    void set_up(const std::string& platform, bool debug);
    void leave_previous();
    void claim_function_table();
    void load_functions();
    void delete_dropped();

    friend std::unique_ptr<Context> open_platform(const Platform& platform, bool debug);

    ContextInfo info_;
    Uploads uploads_;
    std::shared_ptr<ContextState> state_;
    std::unique_ptr<ProgramCache> programs_;
    Backend wanted_ = Backend::automatic;
};

/// Makes a context current for a scope, then puts back what was current on this thread before.
class CurrentScope {
public:
    explicit CurrentScope(Context& context);
    ~CurrentScope();
    CurrentScope(const CurrentScope&) = delete;
    CurrentScope& operator=(const CurrentScope&) = delete;

private:
    Context* context_;
    Context* previous_;
};

/// One way to get a context, tried for `decalgl doctor`.
struct Probe {
    std::string name;  ///< "EGL device 0", "EGL surfaceless Mesa", "OSMesa"
    bool ok = false;
    std::string detail;  ///< renderer and version, or why it failed
    std::string cure;    ///< what to install or set; empty where nothing is wrong
    ContextInfo info;    ///< filled where ok
};

/// Tries every platform, one after the other, and throws nothing. The current context stays as it was.
std::vector<Probe> probe_backends();

/// Throws what went wrong in the current context since the last check: Error(memory) where the driver ran
/// out of memory, else Error(graphics). `where` names the operation in the message.
void check_errors(const char* where);

}  // namespace decalgl::gl
