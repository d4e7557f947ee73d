// How far, in pixels, the ground under a line of this half width may be seen from where a pixel's plane has it: half of the half
// width, but no less than half a pixel, and the slack.
uniform float ground_slack;  // a quarter, and what the terrain's level of detail may be off

float ground_reach(float half_width) {
    return 0.5 * max(half_width, 1.0) + ground_slack;
}
