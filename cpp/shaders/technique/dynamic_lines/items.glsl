// The item of an invocation (dispatch.h), and where in the part of a buffer that is bound its result goes.
layout(local_size_x = 64) in;

uniform uint first_item;
uniform uint item_count;

uint this_item() {
    return first_item + gl_GlobalInvocationID.x;
}

uint this_record() {
    return gl_GlobalInvocationID.x;
}
