#include "gl/sample_query.h"

#include "gl/gl.h"

namespace decalgl::gl {
namespace {

GLuint new_query() {
    GLuint name = 0;
    glCreateQueries(GL_SAMPLES_PASSED, 1, &name);
    return name;
}

}  // namespace

SampleQuery::SampleQuery() : query_(ObjectType::query, new_query()) {
    glBeginQuery(GL_SAMPLES_PASSED, query_.name());
}

SampleQuery::~SampleQuery() {
    if (counting_)
        glEndQuery(GL_SAMPLES_PASSED);
}

uint64_t SampleQuery::count() {
    glEndQuery(GL_SAMPLES_PASSED);
    counting_ = false;
    GLuint64 samples = 0;
    glGetQueryObjectui64v(query_.name(), GL_QUERY_RESULT, &samples);
    return samples;
}

}  // namespace decalgl::gl
