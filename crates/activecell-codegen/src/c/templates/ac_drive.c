/*
 * The control unit of the motors, and the player of programs.
 */
#include "activecell.h"
#include "ac_bit.h"

@CONTROL_FUNCTION@
@PLAYER_FUNCTION@
uint32_t ac_control_step(uint32_t state, uint32_t inputs)
{
    return ac_control_next(state, inputs).next_state;
}

uint32_t ac_control_outputs(uint32_t state)
{
    const ac_control_next_outputs outputs = ac_control_next(state, 0U);
    return outputs.q0 | (outputs.q1 << 1U) | (outputs.q2 << 2U) | (outputs.q3 << 3U);
}

void ac_player_start(ac_player *player, const ac_segment *segments, uint32_t count)
{
    player->segments = segments;
    player->count = count;
    player->segment = 0U;
    player->ticks = 0U;
    player->state = AC_CALM;
}

bool ac_player_is_done(const ac_player *player)
{
    return player->segment >= player->count;
}

/* What the control unit is told for the segment that the player is in. */
static uint32_t inputs_of(const ac_player *player, bool go, uint32_t obstacles)
{
    const bool is_done = ac_player_is_done(player);
    uint32_t motion = 0U;
    if (!is_done) {
        motion = player->segments[player->segment].motion;
    }
    return ac_player_inputs(motion, ac_bit(is_done), ac_bit(go), obstacles >> 2U);
}

uint32_t ac_player_clock(ac_player *player, bool go, bool tick, uint32_t obstacles)
{
    player->state = ac_control_step(player->state, inputs_of(player, go, obstacles));
    if (tick && !ac_player_is_done(player)) {
        player->ticks += 1U;
        if (player->ticks >= player->segments[player->segment].ticks) {
            player->segment += 1U;
            player->ticks = 0U;
        }
    }
    return ac_control_outputs(player->state);
}
