/** Division of work among devices: the value of --split. */
#ifndef SAMPLES_COMMON_SPLIT_H
#define SAMPLES_COMMON_SPLIT_H

enum split {
    SPLIT_FRAME,     ///< Each device traces its tiles of every picture.
    SPLIT_ALTERNATE, ///< Each device traces whole pictures of an animation.
};

#define SPLIT_WORDS "frame|alternate"
#define SPLIT_HELP                                                                                 \
    "how several devices share work; frame: each traces its tiles of 32 x 32 pixels of every "     \
    "picture; alternate: each takes the next picture of --animation"

#endif /* SAMPLES_COMMON_SPLIT_H */
