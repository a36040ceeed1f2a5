// The Node peer of the benchmarks: l1-path-finder. bench/run.sh runs it.
//
//     node peers.mjs WORK OUT paths - -            measure all maps, append records to OUT
//     node peers.mjs WORK OUT paths CASE METHOD    one growing map
//     node peers.mjs versions                      names and versions as JSON
//
// Node 20 has no CPU clock of a thread. Wall time and the CPU time of the whole process are both at least the thread's,
// so the lesser counts: on a busy machine wall time alone would make this peer look slow. The planner is made for each map
// outside the timed part; a query gives the way's corners, not its cells.

import { appendFileSync, readFileSync } from 'node:fs'
import { join } from 'node:path'
import createPlanner from 'l1-path-finder'
import ndarray from 'ndarray'

const PASSES = 3
const SECONDS = Number(process.env.BENCH_SECONDS ?? 2)
const LEAST = Number(process.env.BENCH_LEAST ?? 10)
const NAME = 'l1-path-finder'

function memoryKb(line) {
  try {
    return Number(readFileSync('/proc/self/status', 'utf8').split(line)[1].trim().split(/\s+/)[0])
  } catch {
    return null
  }
}

/** The steps of a way given by its corners; each leg is straight or an L, of the same length either way. */
function steps(corners) {
  let sum = 0
  for (let i = 2; i < corners.length; i += 2) {
    sum += Math.abs(corners[i] - corners[i - 2]) + Math.abs(corners[i + 1] - corners[i - 1])
  }
  return sum
}

const median = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)]

function measure(work, entry) {
  const bytes = new Uint8Array(readFileSync(join(work, entry.name + '.bin')))
  const beforeKb = memoryKb('VmRSS:')
  let start = performance.now()
  // Indexed [x, y].
  const planner = createPlanner(ndarray(bytes, [entry.width, entry.height], [1, entry.width]))
  const setupMs = performance.now() - start
  const times = []
  start = performance.now()
  for (let pass = 0; pass < PASSES; pass++) {
    const tasks = pass === 0 ? entry.tasks.length : times.length
    for (let i = 0; i < tasks; i++) {
      if (performance.now() - start > SECONDS * 1e3 && (pass > 0 || i >= LEAST)) break
      const [sx, sy, tx, ty, wanted] = entry.tasks[i]
      const path = []
      const cpu = process.cpuUsage()
      const clock = process.hrtime.bigint()
      const length = planner.search(sx, sy, tx, ty, path)
      const wallUs = Number(process.hrtime.bigint() - clock) / 1e3
      const { user, system } = process.cpuUsage(cpu)
      // CPU time comes in whole microseconds, too coarse for the shortest queries.
      const us = wallUs < 20 ? wallUs : Math.min(wallUs, user + system)
      if (length !== wanted || steps(path) !== wanted) {
        console.error(`${NAME} on ${entry.name}: from ${sx},${sy} to ${tx},${ty}: ${length} steps, not ${wanted}`)
        process.exit(1)
      }
      if (pass === 0) times.push([])
      times[i].push(us)
    }
  }
  return {
    us: times.map(median),
    case: entry.name,
    part: 'paths',
    method: NAME,
    clock: 'the lesser of wall time and CPU time of the process',
    setup_ms: setupMs,
    before_kb: beforeKb,
    peak_kb: memoryKb('VmHWM:'),
  }
}

const args = process.argv.slice(2)
if (args[0] === 'versions') {
  const version = (name) => JSON.parse(readFileSync(new URL(`node_modules/${name}/package.json`, import.meta.url))).version
  console.log(JSON.stringify({ Node: process.versions.node, [NAME]: version(NAME) }))
} else {
  const [work, out, , only] = args
  for (const entry of JSON.parse(readFileSync(join(work, only === '-' ? 'map.json' : 'grow.json'), 'utf8'))) {
    if (only !== '-' && entry.name !== only) continue
    appendFileSync(out, JSON.stringify(measure(work, entry)) + '\n')
    console.error(`  paths ${entry.name}`)
  }
}
