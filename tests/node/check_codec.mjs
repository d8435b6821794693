// Checks our MAVLink codec against node-mavlink, byte for byte and both ways, for every message both know.
//   node check_codec.mjs <path of frame_dump>
// Exit code 0: equal but for the deviations listed here; 4: something else differs.
import { spawnSync } from 'node:child_process'
import { createRequire } from 'node:module'

const require = createRequire(import.meta.url)
const { MavLinkProtocolV1, MavLinkProtocolV2, MavLinkPacketSignature } = require('node-mavlink')
const { minimal, common, standard, ardupilotmega } = require('mavlink-mappings')

// What node-mavlink 2.3.0 is known to do differently from the MAVLink texts and the C library:
// - it trims an all-zero payload to length 0 instead of 1 (receivers cope; ours must, too);
// - it appends extension fields to MAVLink 1 frames;
// - its definitions (2025-08) lack these messages:
const NOT_IN_NODE = new Set(['COMMAND_CANCEL', 'PARAM_ERROR'])
// - and these extension fields, which were added later:
const FIELDS_NOT_IN_NODE = {}

const tool = process.argv[2]
const run = (mode, input) => {
  const { status, stdout, error } = spawnSync(tool, [mode], { input, maxBuffer: 1 << 28, encoding: 'utf8' })
  if (error || status !== 0) throw error ?? new Error(`${tool} ${mode}: exit code ${status}`)
  return stdout.trim().split('\n').map(line => JSON.parse(line))
}

const classes = { ...minimal.REGISTRY, ...common.REGISTRY, ...standard.REGISTRY, ...ardupilotmega.REGISTRY }
let problems = 0
const complain = (frame, what) => { ++problems; console.error(`${frame.name} ${frame.filling}: ${what}`) }

const toNode = (value, type) => {
  if (Array.isArray(value)) return value.map(v => toNode(v, type.replace('[]', '')))
  if (value === null) return NaN
  return type.startsWith('int64') || type.startsWith('uint64') ? BigInt(value) : value
}
const fromNode = (value, type) => {
  if (Array.isArray(value)) return value.map(v => fromNode(v, type.replace('[]', '')))
  if (typeof value === 'bigint') return value.toString()
  return Number.isNaN(value) ? null : value
}
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b)

const knownFields = (clazz, frame) =>
  clazz.FIELDS.filter(field => !(FIELDS_NOT_IN_NODE[frame.name] ?? []).includes(field.source))

const build = (clazz, frame) => {
  const message = new clazz()
  for (const field of clazz.FIELDS) message[field.name] = toNode(frame.values[field.source], field.type)
  return message
}

const checkNodeReads = (clazz, frame, protocol, hex, withExtensions) => {
  const bytes = Buffer.from(hex, 'hex')
  const header = protocol.header(bytes)
  if (header.sysid !== frame.sysid || header.compid !== frame.compid || header.seq !== frame.seq ||
      header.msgid !== frame.id)
    complain(frame, `${protocol.name}: header read as ${JSON.stringify(header)}`)
  const data = protocol.data(protocol.payload(bytes), clazz)
  for (const field of knownFields(clazz, frame)) {
    if (field.extension && !withExtensions) continue
    const read = fromNode(data[field.name], field.type)
    if (!same(read, frame.values[field.source]))
      complain(frame, `${protocol.name}: ${field.source}: node reads ${JSON.stringify(read)}, we wrote ` +
        JSON.stringify(frame.values[field.source]))
  }
}

const frames = run('encode')
const nodeFrames = []  // what node serialises, for us to read
const counts = { v2: 0, v1: 0, signed: 0, zero: 0, skipped: new Set(), v1Extended: new Set() }

for (const frame of frames) {
  const clazz = classes[frame.id]
  if (!clazz) {
    counts.skipped.add(frame.name)
    if (!NOT_IN_NODE.has(frame.name)) complain(frame, 'node does not know it, and it is not on the list')
    continue
  }
  if (NOT_IN_NODE.has(frame.name)) complain(frame, 'is on the list of messages node lacks, but it has it')
  if (clazz.MAGIC_NUMBER !== frame.crc_extra) complain(frame, `CRC_EXTRA ${clazz.MAGIC_NUMBER} in node`)
  const missing = Object.keys(frame.values).filter(name => !clazz.FIELDS.some(field => field.source === name))
  if (!same(missing, FIELDS_NOT_IN_NODE[frame.name] ?? [])) complain(frame, `fields node lacks: ${missing}`)

  const v2 = new MavLinkProtocolV2(frame.sysid, frame.compid)
  checkNodeReads(clazz, frame, v2, frame.v2, true)
  const message = build(clazz, frame)
  const theirs = v2.serialize(message, frame.seq).toString('hex')
  nodeFrames.push({ frame, hex: theirs, withExtensions: true })
  const allZero = parseInt(frame.v2.slice(2, 4), 16) === 1 && frame.v2.slice(20, 22) === '00'
  if (allZero) {
    ++counts.zero
    if (theirs.slice(2, 4) !== '00') complain(frame, 'node no longer trims an all-zero payload to nothing')
  } else if (missing.length === 0) {
    ++counts.v2
    if (theirs !== frame.v2) complain(frame, `v2: ours ${frame.v2}, node ${theirs}`)
  }

  if (frame.v1) {
    const v1 = new MavLinkProtocolV1(frame.sysid, frame.compid)
    checkNodeReads(clazz, frame, v1, frame.v1, false)
    const theirsV1 = v1.serialize(message, frame.seq).toString('hex')
    nodeFrames.push({ frame, hex: theirsV1, withExtensions: false })
    if (clazz.FIELDS.some(field => field.extension)) {
      counts.v1Extended.add(frame.name)
      if (theirsV1 === frame.v1) complain(frame, 'node no longer appends extensions to v1')
    } else {
      ++counts.v1
      if (theirsV1 !== frame.v1) complain(frame, `v1: ours ${frame.v1}, node ${theirsV1}`)
    }
  }

  if (frame.v2_signed) {
    ++counts.signed
    const signature = new MavLinkPacketSignature(Buffer.from(frame.v2_signed, 'hex'))
    if (!signature.matches(Buffer.from(frame.key, 'hex'))) complain(frame, 'node does not accept our signature')
  }
}

const read = run('decode', nodeFrames.map(({ hex }) => hex).join('\n') + '\n')
nodeFrames.forEach(({ frame, withExtensions }, i) => {
  const clazz = classes[frame.id]
  if (read[i] === null || read[i].name !== frame.name || read[i].seq !== frame.seq)
    return complain(frame, `we read node's frame as ${JSON.stringify(read[i])}`)
  for (const field of knownFields(clazz, frame)) {
    if (field.extension && !withExtensions) continue
    if (!same(read[i].values[field.source], frame.values[field.source]))
      complain(frame, `${field.source}: we read ${JSON.stringify(read[i].values[field.source])} from node's frame`)
  }
})

console.log(`equal bytes: ${counts.v2} v2, ${counts.v1} v1; ${counts.signed} signatures; ` +
  `${nodeFrames.length} frames of node read; known deviations: ${counts.zero} all-zero payloads, ` +
  `v1 extensions of ${counts.v1Extended.size} messages; not in node: ${[...counts.skipped].join(', ')}`)
process.exit(problems === 0 ? 0 : 4)
