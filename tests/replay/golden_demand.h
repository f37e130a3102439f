/** Scenes of demand loading, each a few launches that show one thing. */
#ifndef TESTS_REPLAY_GOLDEN_DEMAND_H
#define TESTS_REPLAY_GOLDEN_DEMAND_H

/** Writes a recording of each into the folder. */
void write_golden_demand(const char *folder);

#endif /* TESTS_REPLAY_GOLDEN_DEMAND_H */
