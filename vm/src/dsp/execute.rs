//! The instructions, one arm each.

use super::decode::{AFTER, DEFERRED, FORESEEN, LONG1, LONG2, MicroOp, NEGATIVE, STEADY, UNSIGNED, UPDATES};
use super::flight::PendingDouble;
use super::memory::Memory;
use super::pipeline::State;
use super::work::Work;
use super::{alu, float, product};
use crate::trap::TrapKind;

impl State {
    /// Executes an instruction whose condition holds. `RENAMED` is set if its results have locations of their own, so
    /// that they are written at once ([`loops`](super::loops)).
    #[inline(always)]
    pub(super) fn execute<const RENAMED: bool, M: Memory>(
        &mut self,
        m: &MicroOp,
        memory: &mut M,
    ) -> Result<(), TrapKind> {
        let s1 = self.regs[usize::from(m.a)].wrapping_add(m.imm);
        let s2 = self.regs[usize::from(m.b)];
        match m.work {
            Work::Add => self.write_result::<RENAMED>(m, s1.wrapping_add(s2)),
            Work::Sub => self.write_result::<RENAMED>(m, s1.wrapping_sub(s2)),
            Work::AddScaled => self.write_result::<RENAMED>(m, s2.wrapping_add(s1 << m.extra)),
            Work::SubScaled => self.write_result::<RENAMED>(m, s2.wrapping_sub(s1 << m.extra)),
            Work::And => self.write_result::<RENAMED>(m, s1 & s2),
            Work::Or => self.write_result::<RENAMED>(m, s1 | s2),
            Work::Xor => self.write_result::<RENAMED>(m, s1 ^ s2),
            Work::Cmpeq => self.write_result::<RENAMED>(m, u32::from(s1 == s2)),
            Work::Cmpgt => self.write_result::<RENAMED>(m, u32::from(s1.cast_signed() > s2.cast_signed())),
            Work::Cmplt => self.write_result::<RENAMED>(m, u32::from(s1.cast_signed() < s2.cast_signed())),
            Work::Cmpgtu => self.write_result::<RENAMED>(m, u32::from(s1 > s2)),
            Work::Cmpltu => self.write_result::<RENAMED>(m, u32::from(s1 < s2)),
            Work::Abs => self.write_result::<RENAMED>(m, alu::abs(s2)),
            Work::Lmbd => self.write_result::<RENAMED>(m, alu::lmbd(s1, s2)),
            Work::Norm => self.write_result::<RENAMED>(m, alu::norm(s2)),
            Work::Sadd => self.write_result::<RENAMED>(m, alu::saturate(signed(s1) + signed(s2))),
            Work::Ssub => self.write_result::<RENAMED>(m, alu::saturate(signed(s1) - signed(s2))),
            Work::Subc => self.write_result::<RENAMED>(m, alu::subc(s1, s2)),
            Work::Add2 => self.write_result::<RENAMED>(m, alu::add2(s1, s2)),
            Work::Sub2 => self.write_result::<RENAMED>(m, alu::sub2(s1, s2)),
            Work::Clr => self.write_result::<RENAMED>(m, alu::clr(s1, s2)),
            Work::Set => self.write_result::<RENAMED>(m, alu::set(s1, s2)),
            Work::Ext => self.write_result::<RENAMED>(m, alu::ext(s1, s2)),
            Work::Extu => self.write_result::<RENAMED>(m, alu::extu(s1, s2)),
            Work::Shl => self.write_result::<RENAMED>(m, alu::shl(s1, s2)),
            Work::Shr => self.write_result::<RENAMED>(m, alu::shr(s1, s2)),
            Work::Shru => self.write_result::<RENAMED>(m, alu::shru(s1, s2)),
            Work::Sshl => self.write_result::<RENAMED>(m, alu::sshl(s1, s2)),
            Work::Mvk => self.write_result::<RENAMED>(m, m.imm),
            Work::Mvkh => self.write_result::<RENAMED>(m, m.imm | self.regs[usize::from(m.dst)] & 0xFFFF),
            Work::AddLong => self.give_long::<RENAMED>(m, self.long1(m) + self.long2(m)),
            Work::SubLong => self.give_long::<RENAMED>(m, self.long1(m) - self.long2(m)),
            Work::SaddLong => self.give_long::<RENAMED>(m, alu::saturate_long(self.long1(m) + self.long2(m))),
            Work::SsubLong => self.give_long::<RENAMED>(m, alu::saturate_long(self.long1(m) - self.long2(m))),
            Work::AbsLong => self.give_long::<RENAMED>(m, self.long2(m).abs()),
            Work::CmpeqLong => self.write_result::<RENAMED>(m, u32::from(self.long1(m) == self.long2(m))),
            Work::CmpgtLong => self.write_result::<RENAMED>(m, u32::from(self.long1(m) > self.long2(m))),
            Work::CmpltLong => self.write_result::<RENAMED>(m, u32::from(self.long1(m) < self.long2(m))),
            Work::CmpgtuLong => {
                self.write_result::<RENAMED>(m, u32::from(unsigned(self.long1(m)) > unsigned(self.long2(m))));
            }
            Work::CmpltuLong => {
                self.write_result::<RENAMED>(m, u32::from(unsigned(self.long1(m)) < unsigned(self.long2(m))));
            }
            Work::NormLong => self.write_result::<RENAMED>(m, alu::norm_long(self.long2(m))),
            Work::SatLong => self.write_result::<RENAMED>(m, alu::saturate(self.long2(m))),
            Work::ShlLong => self.give_long::<RENAMED>(m, alu::shl_long(i64::from(s1), self.long2(m))),
            Work::ShrLong => self.give_long::<RENAMED>(m, alu::shr_long(i64::from(s1), self.long2(m))),
            Work::ShruLong => self.give_long::<RENAMED>(m, alu::shru_long(i64::from(s1), self.long2(m))),
            Work::Product => self.land::<RENAMED>(2, m.dst, product::multiply(m.extra, s1, s2)),
            Work::Mpyi => self.land::<RENAMED>(9, m.dst, s1.wrapping_mul(s2)),
            Work::Mpyid => self.land_pair::<RENAMED>(9, 10, m.dst, (signed(s1) * signed(s2)).cast_unsigned()),
            Work::Addsp => self.land::<RENAMED>(4, m.dst, float::addsp(s1, s2)),
            Work::Subsp => self.land::<RENAMED>(4, m.dst, float::subsp(s1, s2)),
            Work::Mpysp => self.land::<RENAMED>(4, m.dst, float::mpysp(s1, s2)),
            Work::Intsp => self.land::<RENAMED>(4, m.dst, float::intsp(s2)),
            Work::Intspu => self.land::<RENAMED>(4, m.dst, float::intspu(s2)),
            Work::Spint => self.land::<RENAMED>(4, m.dst, float::spint(s2)),
            Work::Sptrunc => self.land::<RENAMED>(4, m.dst, float::sptrunc(s2)),
            Work::Dpint => self.land::<RENAMED>(4, m.dst, float::dpint(self.double2(m))),
            Work::Dptrunc => self.land::<RENAMED>(4, m.dst, float::dptrunc(self.double2(m))),
            Work::Dpsp => self.land::<RENAMED>(4, m.dst, float::dpsp(self.double2(m))),
            Work::Intdp => self.land_pair::<RENAMED>(4, 5, m.dst, float::intdp(s2)),
            Work::Intdpu => self.land_pair::<RENAMED>(4, 5, m.dst, float::intdpu(s2)),
            Work::Spdp => self.give_double::<RENAMED>(m, float::spdp(s2)),
            Work::Abssp => self.write_result::<RENAMED>(m, s2 & 0x7FFF_FFFF),
            Work::Absdp => self.give_double::<RENAMED>(m, self.double2(m) & !(1 << 63)),
            Work::Cmpeqsp => {
                self.write_result::<RENAMED>(m, u32::from(float::single(s1) == float::single(s2)));
            }
            Work::Cmpgtsp => {
                self.write_result::<RENAMED>(m, u32::from(float::single(s1) > float::single(s2)));
            }
            Work::Cmpltsp => {
                self.write_result::<RENAMED>(m, u32::from(float::single(s1) < float::single(s2)));
            }
            Work::Rcpsp => self.write_result::<RENAMED>(m, float::rcpsp(s2)),
            Work::Rsqrsp => self.write_result::<RENAMED>(m, float::rsqrsp(s2)),
            Work::Rcpdp => self.give_double::<RENAMED>(m, float::rcpdp(self.double2(m))),
            Work::Rsqrdp => self.give_double::<RENAMED>(m, float::rsqrdp(self.double2(m))),
            Work::Adddp => match self.words::<RENAMED>(m, 1, s1, s2) {
                Some((s1, s2)) => self.land_pair::<RENAMED>(6, 7, m.dst, float::adddp(s1, s2)),
                None => self.start_double::<RENAMED>(m, s1, s2),
            },
            Work::Mpydp => match self.product_words::<RENAMED>(m, s1, s2) {
                Some((s1, s2)) => self.land_pair::<RENAMED>(9, 10, m.dst, float::mpydp(s1, s2)),
                None => self.start_double::<RENAMED>(m, s1, s2),
            },
            Work::Subdp | Work::Cmpeqdp | Work::Cmpgtdp | Work::Cmpltdp | Work::Mpyspdp => {
                self.start_double::<RENAMED>(m, s1, s2);
            }
            Work::Mpysp2dp => self.land_pair::<RENAMED>(4, 5, m.dst, float::mpysp2dp(s1, s2)),
            Work::Ldbu => {
                let addr = self.address::<RENAMED>(m, s1, s2);
                let value = memory.load8(addr, &mut self.clock)?;
                self.land::<RENAMED>(5, m.dst, value);
            }
            Work::Ldb => {
                let addr = self.address::<RENAMED>(m, s1, s2);
                let value = memory.load8(addr, &mut self.clock)?;
                self.land::<RENAMED>(5, m.dst, value as u8 as i8 as u32);
            }
            Work::Ldhu => {
                let addr = self.address::<RENAMED>(m, s1, s2) & !1;
                let value = memory.load16(addr, &mut self.clock)?;
                self.land::<RENAMED>(5, m.dst, value);
            }
            Work::Ldh => {
                let addr = self.address::<RENAMED>(m, s1, s2) & !1;
                let value = memory.load16(addr, &mut self.clock)?;
                self.land::<RENAMED>(5, m.dst, value as u16 as i16 as u32);
            }
            Work::Ldw => {
                let addr = self.address::<RENAMED>(m, s1, s2) & !3;
                let value = memory.load32(addr, &mut self.clock)?;
                self.land::<RENAMED>(5, m.dst, value);
            }
            Work::Lddw => {
                let addr = self.address::<RENAMED>(m, s1, s2) & !7;
                let value = memory.load64(addr, &mut self.clock)?;
                self.land_both::<RENAMED>(5, m.dst, value);
            }
            Work::Stb => {
                let addr = self.address::<RENAMED>(m, s1, s2);
                memory.store8(addr, self.regs[usize::from(m.dst)], &mut self.clock)?;
            }
            Work::Sth => {
                let addr = self.address::<RENAMED>(m, s1, s2) & !1;
                memory.store16(addr, self.regs[usize::from(m.dst)], &mut self.clock)?;
            }
            Work::Stw => {
                let addr = self.address::<RENAMED>(m, s1, s2) & !3;
                memory.store32(addr, self.regs[usize::from(m.dst)], &mut self.clock)?;
            }
            Work::BranchTo => self.branch(m.imm),
            Work::BranchRegister => self.branch(s2),
            Work::BranchIrp => {
                let target = self.return_from_interrupt();
                self.branch(target);
            }
            Work::BranchNrp => {
                let target = self.return_from_nmi();
                self.branch(target);
            }
            Work::ReadControl => {
                let value = self.read_control(m.extra);
                self.write_result::<RENAMED>(m, value);
            }
            Work::WriteControl => self.write_control(m.extra, s2),
            Work::Idle => self.is_idle = true,
            Work::Nop => {}
        }
        Ok(())
    }

    /// Schedules a result that lands `delay` cycles from now.
    #[inline(always)]
    fn land<const RENAMED: bool>(&mut self, delay: u64, reg: u8, value: u32) {
        if RENAMED {
            self.regs[usize::from(reg)] = value;
        } else {
            self.push(delay, reg, value);
        }
    }

    /// The low and the high word of a result.
    #[inline(always)]
    fn land_pair<const RENAMED: bool>(&mut self, low_delay: u64, high_delay: u64, reg: u8, value: u64) {
        self.land::<RENAMED>(low_delay, reg, value as u32);
        self.land::<RENAMED>(high_delay, reg | 1, (value >> 32) as u32);
    }

    /// Lands both words of a result in the same cycle.
    #[inline(always)]
    fn land_both<const RENAMED: bool>(&mut self, delay: u64, reg: u8, value: u64) {
        if RENAMED {
            // The register is known to be even, so both words are written at once.
            self.land_pair::<RENAMED>(delay, delay, reg & !1, value);
        } else {
            self.push_both(delay, reg, value);
        }
    }

    /// A result of E1.
    #[inline(always)]
    fn write_result<const RENAMED: bool>(&mut self, m: &MicroOp, value: u32) {
        self.write_or_defer::<RENAMED>(m, m.dst, value);
    }

    #[inline(always)]
    fn write_or_defer<const RENAMED: bool>(&mut self, m: &MicroOp, reg: u8, value: u32) {
        if RENAMED || m.flags & DEFERRED != 0 {
            self.land::<RENAMED>(1, reg, value);
        } else {
            self.write(reg, value);
        }
    }

    /// A 40-bit result of E1.
    fn give_long<const RENAMED: bool>(&mut self, m: &MicroOp, value: i64) {
        let value = alu::to_unsigned_long(value);
        self.write_or_defer::<RENAMED>(m, m.dst, value as u32);
        self.write_or_defer::<RENAMED>(m, m.dst | 1, (value >> 32) as u32);
    }

    /// Schedules a double whose low word is available in E1 and its high word in E2.
    fn give_double<const RENAMED: bool>(&mut self, m: &MicroOp, value: u64) {
        self.write_result::<RENAMED>(m, value as u32);
        self.land::<RENAMED>(2, m.dst | 1, (value >> 32) as u32);
    }

    fn double2(&self, m: &MicroOp) -> u64 {
        self.pair(m.b, m.b_high)
    }

    fn pair(&self, low: u8, high: u8) -> u64 {
        join(self.regs[usize::from(low)], self.regs[usize::from(high)])
    }

    /// s1 of 40-bit arithmetic.
    fn long1(&self, m: &MicroOp) -> i64 {
        if m.flags & LONG1 != 0 {
            return alu::to_long(self.pair(m.a, m.a_high).cast_signed());
        }
        widen(m, self.regs[usize::from(m.a)].wrapping_add(m.imm))
    }

    /// s2 of 40-bit arithmetic.
    fn long2(&self, m: &MicroOp) -> i64 {
        if m.flags & LONG2 != 0 {
            return alu::to_long(self.pair(m.b, m.b_high).cast_signed());
        }
        widen(m, self.regs[usize::from(m.b)])
    }

    /// The address of a load or store; the base changes.
    #[inline(always)]
    fn address<const RENAMED: bool>(&mut self, m: &MicroOp, base_and_constant: u32, offset: u32) -> u32 {
        let offset = offset << m.extra;
        let sum = if m.flags & NEGATIVE == 0 {
            base_and_constant.wrapping_add(offset)
        } else {
            base_and_constant.wrapping_sub(offset)
        };
        if m.flags & UPDATES == 0 {
            return sum;
        }
        let base = self.regs[usize::from(m.a)];
        self.write_or_defer::<RENAMED>(m, m.a, sum);
        if m.flags & AFTER == 0 { sum } else { base }
    }

    /// All words of a double instruction that reads the high word of s1 after `cycles` cycles and the high word of s2
    /// after one; `None` if those values are not known yet.
    #[inline(always)]
    fn words<const RENAMED: bool>(
        &self,
        m: &MicroOp,
        cycles: u64,
        low1: u32,
        low2: u32,
    ) -> Option<(u64, u64)> {
        if !RENAMED && m.flags & STEADY == 0 {
            return None;
        }
        if RENAMED || !self.arrives_within(cycles, m.a_high, m.b_high) {
            let [high1, high2] = [m.a_high, m.b_high].map(|high| self.regs[usize::from(high)]);
            return Some((join(low1, high1), join(low2, high2)));
        }
        let (high1, high2) = (self.after(cycles, m.a_high), self.after(1, m.b_high));
        Some((join(low1, high1), join(low2, high2)))
    }

    /// Returns both sources of a product, if its high words are certain before the next packet executes.
    #[inline(always)]
    fn product_words<const RENAMED: bool>(&self, m: &MicroOp, low1: u32, low2: u32) -> Option<(u64, u64)> {
        let is_foreseen = RENAMED || m.extra & FORESEEN != 0 && !self.branches_next();
        if is_foreseen { self.words::<RENAMED>(m, 2, low1, low2) } else { None }
    }

    /// Starts a double instruction that reads its high words after E1; it is computed at once if those values are
    /// already known.
    fn start_double<const RENAMED: bool>(&mut self, m: &MicroOp, low1: u32, low2: u32) {
        let is_product = m.work == Work::Mpydp;
        let words = if is_product { None } else { self.words::<RENAMED>(m, 1, low1, low2) };
        match words {
            Some((s1, s2)) => self.finish_double::<RENAMED>(m, 0, s1, s2),
            None => self.push_late(PendingDouble {
                due: self.clock.cycle + 1,
                issued: self.clock.cycle,
                micro: *m,
                low1,
                low2,
                high2: None,
            }),
        }
    }

    /// The next read of a double instruction.
    pub(super) fn continue_late(&mut self, late: PendingDouble) {
        let high1 = self.regs[usize::from(late.micro.a_high)];
        let high2 = self.regs[usize::from(late.micro.b_high)];
        if late.micro.work == Work::Mpydp && late.high2.is_none() {
            self.push_late(PendingDouble { due: self.clock.cycle + 1, high2: Some(high2), ..late });
            return;
        }
        let s2 = join(late.low2, late.high2.unwrap_or(high2));
        self.finish_double::<false>(&late.micro, self.clock.cycle - late.issued, join(late.low1, high1), s2);
    }

    /// Computes a double instruction with all of its words, `passed` cycles after the issue.
    fn finish_double<const RENAMED: bool>(&mut self, m: &MicroOp, passed: u64, s1: u64, s2: u64) {
        let dst = m.dst;
        let (a, b) = (float::double(s1), float::double(s2));
        match m.work {
            Work::Adddp => self.land_pair::<RENAMED>(6 - passed, 7 - passed, dst, float::adddp(s1, s2)),
            Work::Subdp => self.land_pair::<RENAMED>(6 - passed, 7 - passed, dst, float::subdp(s1, s2)),
            Work::Mpydp => self.land_pair::<RENAMED>(9 - passed, 10 - passed, dst, float::mpydp(s1, s2)),
            Work::Mpyspdp => {
                self.land_pair::<RENAMED>(6 - passed, 7 - passed, dst, float::mpyspdp(s1 as u32, s2));
            }
            Work::Cmpgtdp => self.land::<RENAMED>(2 - passed, dst, u32::from(a > b)),
            Work::Cmpltdp => self.land::<RENAMED>(2 - passed, dst, u32::from(a < b)),
            // Only these seven instructions start this way; see `start_double`.
            _ => self.land::<RENAMED>(2 - passed, dst, u32::from(a == b)),
        }
    }
}

fn join(low: u32, high: u32) -> u64 {
    u64::from(low) | u64::from(high) << 32
}

fn signed(value: u32) -> i64 {
    i64::from(value.cast_signed())
}

fn unsigned(value: i64) -> u64 {
    alu::to_unsigned_long(value)
}

/// A 32-bit source of 40-bit arithmetic.
fn widen(m: &MicroOp, value: u32) -> i64 {
    if m.flags & UNSIGNED != 0 { i64::from(value) } else { signed(value) }
}
