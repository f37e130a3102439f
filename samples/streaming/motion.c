#include "motion.h"

#include <math.h>

/* What is less than this in all is standing still. */
#define STILL_METERS 0.004f
#define STILL_RADIANS 0.004f

#define MOST_SPEEDING_UP 1.0f ///< times the way that the speed of now makes
#define JUMP 4.0f             ///< times as long as the other steps together

enum { OLDEST = 0, MIDDLE = MOTION_FRAMES / 2, NEWEST = MOTION_FRAMES - 1 };

static float length_of(struct vec3 a)
{
    return sqrtf(vec3_dot(a, a));
}

static bool is_camera(const struct camera *camera)
{
    float distance = length_of(vec3_sub(camera->target, camera->eye));
    return isfinite(length_of(camera->eye)) && isfinite(distance) && distance > 0.0f;
}

void motion_add(struct motion *motion, const struct camera *camera, double seconds)
{
    double step = seconds - motion->times[NEWEST];
    if (!is_camera(camera) || !isfinite(seconds)) {
        motion->count = 0;
        return;
    }
    if (motion->count > 0 && !(step > 0.0 && step <= MOTION_LONGEST_STEP))
        motion->count = 0;
    for (int i = 0; i < NEWEST; i++) {
        motion->past[i] = motion->past[i + 1];
        motion->times[i] = motion->times[i + 1];
    }
    motion->past[NEWEST] = *camera;
    motion->times[NEWEST] = seconds;
    if (motion->count < MOTION_FRAMES)
        motion->count++;
}

/** Speed and its change at the newest of some points in time: exact for parabolas. */
static void fit(const struct vec3 points[MOTION_FRAMES], const double times[MOTION_FRAMES],
                struct vec3 *speed, struct vec3 *change)
{
    double before = times[MIDDLE] - times[OLDEST], after = times[NEWEST] - times[MIDDLE];
    struct vec3 old_speed =
        vec3_scale(vec3_sub(points[MIDDLE], points[OLDEST]), (float)(1.0 / before));
    struct vec3 new_speed =
        vec3_scale(vec3_sub(points[NEWEST], points[MIDDLE]), (float)(1.0 / after));
    *change = vec3_scale(vec3_sub(new_speed, old_speed), (float)(2.0 / (before + after)));
    *speed = vec3_add(new_speed, vec3_scale(*change, (float)(after / 2.0)));
}

/** Whether one step is far longer than all others together. */
static bool has_jump(const struct vec3 points[MOTION_FRAMES], float still)
{
    float longest = 0.0f, all = 0.0f;
    for (int i = 0; i < NEWEST; i++) {
        float step = length_of(vec3_sub(points[i + 1], points[i]));
        longest = fmaxf(longest, step);
        all += step;
    }
    return longest > still && longest > JUMP * (all - longest);
}

/** The way from the newest point on. */
static struct vec3 way_ahead(const struct vec3 points[MOTION_FRAMES],
                             const double times[MOTION_FRAMES], float seconds, float still)
{
    const struct vec3 none = {0.0f, 0.0f, 0.0f};
    struct vec3 speed, change;
    if (has_jump(points, still))
        return none;
    fit(points, times, &speed, &change);
    float along = vec3_dot(speed, change);
    if (along < 0.0f) /* slows down, to a halt */
        seconds = fminf(seconds, vec3_dot(speed, speed) / -along);
    struct vec3 even = vec3_scale(speed, seconds);
    struct vec3 bend = vec3_scale(change, 0.5f * seconds * seconds);
    float most = MOST_SPEEDING_UP * length_of(even), length = length_of(bend);
    if (length > most)
        bend = vec3_scale(bend, most / length);
    struct vec3 way = vec3_add(even, bend);
    float far = length_of(way);
    return isfinite(far) && far > still ? way : none;
}

/** `direction` turned about the axis that is at a right angle to it and to `way`, an arc in
 * radians. */
static struct vec3 turn(struct vec3 direction, struct vec3 way)
{
    way = vec3_sub(way, vec3_scale(direction, vec3_dot(way, direction)));
    float angle = length_of(way);
    if (!(angle > 0.0f))
        return direction;
    float most = fminf(angle, 1.5f); /* and not to where nothing of the picture is left */
    return vec3_add(vec3_scale(direction, cosf(most)), vec3_scale(way, sinf(most) / angle));
}

bool motion_look_ahead(const struct motion *motion, double seconds, struct camera *ahead)
{
    struct vec3 eyes[MOTION_FRAMES], directions[MOTION_FRAMES];
    *ahead = motion->past[NEWEST];
    if (motion->count < MOTION_FRAMES || !(seconds > 0.0))
        return false;
    for (int i = 0; i < MOTION_FRAMES; i++) {
        const struct camera *camera = &motion->past[i];
        eyes[i] = camera->eye;
        directions[i] = vec3_normalize(vec3_sub(camera->target, camera->eye));
    }
    struct vec3 way = way_ahead(eyes, motion->times, (float)seconds, STILL_METERS);
    struct vec3 arc = way_ahead(directions, motion->times, (float)seconds, STILL_RADIANS);
    float distance = length_of(vec3_sub(ahead->target, ahead->eye));
    ahead->eye = vec3_add(eyes[NEWEST], way);
    ahead->target = vec3_add(ahead->eye, vec3_scale(turn(directions[NEWEST], arc), distance));
    return length_of(way) > 0.0f || length_of(arc) > 0.0f;
}
