// A Slurm of our own on one machine: munge, controller and two virtual nodes on loopback, all in one temporary folder.
import { execFile, spawn } from 'node:child_process';
import crypto from 'node:crypto';
import fs from 'node:fs';
import net from 'node:net';
import os from 'node:os';
import path from 'node:path';
import { promisify } from 'node:util';
import { eventually } from './support.mjs';

const execute = promisify(execFile);
const programs = ['/usr/sbin/munged', '/usr/sbin/slurmctld', '/usr/sbin/slurmd', '/usr/bin/sbatch'];
/** Why Slurm cannot be tested here; nothing when it can. */
export function missing() {
  const absent = programs.filter((file) => !fs.existsSync(file));
  if (absent.length > 0) return `not installed: ${absent.join(', ')}; scripts/setup --tests installs it`;
  return process.getuid() === 0 ? undefined : 'munged and slurmd need root';
}

async function freePorts(count) {
  const servers = await Promise.all(Array.from({ length: count }, () => new Promise((resolve) => {
    const server = net.createServer().listen(0, '127.0.0.1', () => resolve(server));
  })));
  const ports = servers.map((server) => server.address().port);
  await Promise.all(servers.map((server) => new Promise((resolve) => server.close(resolve))));
  return ports;
}

export class Slurm {
  static async start() {
    const slurm = new Slurm();
    // Munge wants folders that nobody else may write to, all the way up; /run is such a place.
    slurm.folder = fs.mkdtempSync(path.join(fs.existsSync('/run') ? '/run' : os.tmpdir(), 'stagger-slurm-'));
    slurm.children = new Map();
    try {
      await slurm.begin();
    } catch (error) {
      await slurm.end();
      throw error;
    }
    return slurm;
  }

  async begin() {
    const at = (name) => path.join(this.folder, name);
    const host = os.hostname();
    const [controller, first, second] = await freePorts(3);
    for (const name of ['munge', 'state', 'spool-node1', 'spool-node2']) fs.mkdirSync(at(name), { mode: 0o755 });
    fs.writeFileSync(at('munge/key'), crypto.randomBytes(256), { mode: 0o400 });
    const socket = at('munge/socket');
    this.run('munged', '/usr/sbin/munged', ['--foreground', '--force', `--socket=${socket}`,
      `--key-file=${at('munge/key')}`, `--log-file=${at('munge/log')}`, `--pid-file=${at('munge/pid')}`,
      `--seed-file=${at('munge/seed')}`]);
    await eventually(() => fs.existsSync(socket), 'munge');

    const node = (name, port) =>
      `NodeName=${name} NodeHostname=${host} NodeAddr=127.0.0.1 Port=${port} CPUs=2 State=UNKNOWN`;
    fs.writeFileSync(at('slurm.conf'), `
ClusterName=stagger
SlurmctldHost=${host}(127.0.0.1)
SlurmctldPort=${controller}
AuthType=auth/munge
AuthInfo=socket=${socket}
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmUser=root
SlurmdUser=root
StateSaveLocation=${at('state')}
SlurmdSpoolDir=${this.folder}/spool-%n
SlurmctldPidFile=${at('slurmctld.pid')}
SlurmdPidFile=${this.folder}/slurmd-%n.pid
SlurmctldLogFile=${at('slurmctld.log')}
SlurmdLogFile=${this.folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
SlurmdTimeout=10
KillWait=2
${node('node1', first)}
${node('node2', second)}
PartitionName=all Nodes=node1,node2 Default=YES MaxTime=INFINITE State=UP
`);
    this.environment = { SLURM_CONF: at('slurm.conf') };
    this.run('slurmctld', '/usr/sbin/slurmctld', ['-D']);
    for (const name of ['node1', 'node2']) this.startNode(name);
    await eventually(async () => (await this.command('sinfo', '-h', '-N', '-o', '%T')) === 'idle\nidle', 'two idle nodes');
  }

  run(name, program, args) {
    const child = spawn(program, args, { env: { ...process.env, ...this.environment }, stdio: 'ignore', detached: true });
    this.children.set(name, child);
    child.ended = new Promise((resolve) => child.on('close', resolve));
    child.on('error', () => {});
  }
  startNode(name) {
    this.run(name, '/usr/sbin/slurmd', ['-D', '-N', name]);
  }
  /** The node is gone, with what runs on it. */
  async killNode(name) {
    const jobs = this.stepsOf(name);
    await this.stop(name);
    for (const pid of jobs) killGroup(pid);
  }
  /** Processes of the node's jobs: slurmstepd is no child of slurmd. */
  stepsOf(name) {
    const mine = (pid) => {
      try {
        const line = fs.readFileSync(`/proc/${pid}/environ`, 'latin1').split('\0');
        return line.includes(`SLURMD_NODENAME=${name}`) && line.includes(`SLURM_CONF=${this.environment.SLURM_CONF}`);
      } catch {
        return false;
      }
    };
    return fs.readdirSync('/proc').filter((entry) => /^\d+$/.test(entry)).filter(mine).map(Number);
  }
  async stop(name) {
    const child = this.children.get(name);
    this.children.delete(name);
    killGroup(child.pid);
    await child.ended;
  }

  async command(program, ...args) {
    try {
      const { stdout } = await execute(program, args, { env: { ...process.env, ...this.environment }, timeout: 60_000 });
      return stdout.trim();
    } catch (error) {
      return `${error.message}`;
    }
  }

  async end() {
    for (const name of ['node1', 'node2']) {
      if (this.environment) for (const pid of this.stepsOf(name)) killGroup(pid);
    }
    for (const name of [...this.children.keys()].reverse()) await this.stop(name);
    fs.rmSync(this.folder, { recursive: true, force: true });
  }
}

function killGroup(pid) {
  for (const target of [-pid, pid]) {
    try {
      process.kill(target, 'SIGKILL');
    } catch {
      // it has gone
    }
  }
}
