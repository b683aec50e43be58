//! Translation of the integer instructions; the interpreter has them in `execute.rs`.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value, types};

use super::super::decode::{LONG1, LONG2, MicroOp, UNSIGNED};
use super::super::product::Halves;
use super::super::work::Work;
use super::packet::PacketState;
use super::region::{NoNextPacket, PairWord, Translator};

/// Bits of a long.
const LONG: i64 = 40;

impl Translator<'_, '_> {
    /// Translates an instruction whose condition is known.
    pub(super) fn micro(&mut self, packet_state: &mut PacketState, m: &MicroOp) -> Result<(), NoNextPacket> {
        let base = self.read(packet_state, m.a);
        let s1 = if m.imm == 0 { base } else { self.builder.ins().iadd_imm_s(base, signed(m.imm)) };
        let s2 = self.read(packet_state, m.b);
        match m.work {
            Work::Add
            | Work::Sub
            | Work::AddScaled
            | Work::SubScaled
            | Work::And
            | Work::Or
            | Work::Xor
            | Work::Cmpeq
            | Work::Cmpgt
            | Work::Cmplt
            | Work::Cmpgtu
            | Work::Cmpltu
            | Work::Abs
            | Work::Lmbd
            | Work::Norm
            | Work::Sadd
            | Work::Ssub
            | Work::Subc
            | Work::Add2
            | Work::Sub2
            | Work::Clr
            | Work::Set
            | Work::Ext
            | Work::Extu
            | Work::Shl
            | Work::Shr
            | Work::Shru
            | Work::Sshl
            | Work::Mvk
            | Work::Mvkh => {
                let value = self.word(packet_state, m, s1, s2)?;
                self.write_result(packet_state, m, m.dst, value)
            }
            Work::AddLong | Work::SubLong | Work::ShlLong | Work::ShrLong | Work::ShruLong => {
                let value = self.long(packet_state, m, s1)?;
                self.write_long(packet_state, m, value)
            }
            Work::CmpeqLong | Work::CmpgtLong | Work::CmpltLong | Work::CmpgtuLong | Work::CmpltuLong => {
                let value = self.compare_long(packet_state, m);
                self.write_result(packet_state, m, m.dst, value)
            }
            Work::Product => {
                let value = self.product(m.extra, s1, s2);
                self.push(packet_state, 2, m.dst, value)
            }
            Work::Mpyi => {
                let value = self.builder.ins().imul(s1, s2);
                self.push(packet_state, 9, m.dst, value)
            }
            Work::Mpyid => {
                let (wide1, wide2) = (self.sign(s1), self.sign(s2));
                let value = self.builder.ins().imul(wide1, wide2);
                self.push_pair(packet_state, [9, 10], m.dst, value)
            }
            Work::Addsp | Work::Subsp | Work::Mpysp => {
                let value = self.single(m.work, s1, s2);
                self.push(packet_state, 4, m.dst, value)
            }
            Work::Intsp | Work::Intspu | Work::Sptrunc | Work::Dptrunc | Work::Dpsp => {
                let value = self.converted(packet_state, m, s2);
                self.push(packet_state, 4, m.dst, value)
            }
            Work::Intdp | Work::Intdpu => {
                let value = self.double_of_integer(m.work, s2);
                self.push_pair(packet_state, [4, 5], m.dst, value)
            }
            Work::Mpysp2dp => {
                let value = self.double_product_of_singles(s1, s2);
                self.push_pair(packet_state, [4, 5], m.dst, value)
            }
            Work::Spdp | Work::Absdp | Work::Rcpdp => {
                let value = self.double_at_once(packet_state, m, s2);
                self.give_double(packet_state, m, value)
            }
            Work::Abssp => {
                let value = self.builder.ins().band_imm_u(s2, 0x7FFF_FFFF);
                self.write_result(packet_state, m, m.dst, value)
            }
            Work::Cmpeqsp | Work::Cmpgtsp | Work::Cmpltsp => {
                let value = self.compare_singles(m.work, s1, s2);
                self.write_result(packet_state, m, m.dst, value)
            }
            Work::Rcpsp => {
                let value = self.reciprocal_single(s2);
                self.write_result(packet_state, m, m.dst, value)
            }
            Work::Adddp
            | Work::Subdp
            | Work::Cmpeqdp
            | Work::Cmpgtdp
            | Work::Cmpltdp
            | Work::Mpydp
            | Work::Mpyspdp => {
                self.start_double(packet_state, m, [s1, s2]);
                Ok(())
            }
            Work::Ldbu | Work::Ldb | Work::Ldhu | Work::Ldh | Work::Ldw | Work::Lddw => {
                let address = self.address(packet_state, m, [base, s1, s2])?;
                self.load(packet_state, m, address)
            }
            Work::Stb | Work::Sth | Work::Stw => {
                let address = self.address(packet_state, m, [base, s1, s2])?;
                self.store(packet_state, m, address);
                Ok(())
            }
            Work::BranchTo => self.branch(packet_state, Ok(m.imm)),
            Work::BranchRegister => self.branch(packet_state, Err(s2)),
            Work::Nop => Ok(()),
            // Control registers, and rare instructions.
            Work::SaddLong
            | Work::SsubLong
            | Work::AbsLong
            | Work::NormLong
            | Work::SatLong
            | Work::Spint
            | Work::Dpint
            | Work::Rsqrsp
            | Work::Rsqrdp
            | Work::BranchIrp
            | Work::BranchNrp
            | Work::ReadControl
            | Work::WriteControl
            | Work::Idle => Err(NoNextPacket::PacketInterpreted),
        }
    }

    /// Adds a word that is available in the first stage.
    fn word(
        &mut self,
        packet_state: &PacketState,
        m: &MicroOp,
        s1: Value,
        s2: Value,
    ) -> Result<Value, NoNextPacket> {
        let builder = &mut self.builder;
        Ok(match m.work {
            Work::Add => builder.ins().iadd(s1, s2),
            Work::Sub => builder.ins().isub(s1, s2),
            Work::AddScaled => {
                let scaled = builder.ins().ishl_imm_u(s1, i64::from(m.extra));
                builder.ins().iadd(s2, scaled)
            }
            Work::SubScaled => {
                let scaled = builder.ins().ishl_imm_u(s1, i64::from(m.extra));
                builder.ins().isub(s2, scaled)
            }
            Work::And => builder.ins().band(s1, s2),
            Work::Or => builder.ins().bor(s1, s2),
            Work::Xor => builder.ins().bxor(s1, s2),
            Work::Cmpeq => self.test(IntCC::Equal, s1, s2),
            Work::Cmpgt => self.test(IntCC::SignedGreaterThan, s1, s2),
            Work::Cmplt => self.test(IntCC::SignedLessThan, s1, s2),
            Work::Cmpgtu => self.test(IntCC::UnsignedGreaterThan, s1, s2),
            Work::Cmpltu => self.test(IntCC::UnsignedLessThan, s1, s2),
            Work::Abs => {
                let wide = self.sign(s2);
                let wide = self.builder.ins().iabs(wide);
                self.saturate(wide)
            }
            Work::Lmbd => self.leftmost(s1, s2),
            Work::Norm => builder.ins().cls(s2),
            Work::Sadd | Work::Ssub => {
                let (wide1, wide2) = (self.sign(s1), self.sign(s2));
                let ins = self.builder.ins();
                let wide = if m.work == Work::Sadd { ins.iadd(wide1, wide2) } else { ins.isub(wide1, wide2) };
                self.saturate(wide)
            }
            Work::Subc => {
                let less = builder.ins().icmp(IntCC::UnsignedLessThan, s1, s2);
                let rest = builder.ins().isub(s1, s2);
                let rest = builder.ins().ishl_imm_u(rest, 1);
                let rest = builder.ins().iadd_imm_s(rest, 1);
                let twice = builder.ins().ishl_imm_u(s1, 1);
                builder.ins().select(less, twice, rest)
            }
            Work::Add2 | Work::Sub2 => self.halves(m.work == Work::Add2, s1, s2),
            Work::Clr | Work::Set => self.bits(m.work == Work::Set, s1, s2),
            Work::Ext | Work::Extu => self.field(m.work == Work::Ext, s1, s2),
            Work::Shl | Work::Shr | Work::Shru | Work::Sshl => self.shift(m.work, s1, s2),
            Work::Mvk => builder.ins().iconst(types::I32, i64::from(m.imm)),
            Work::Mvkh => {
                let low = self.read(packet_state, m.dst);
                let low = self.builder.ins().band_imm_u(low, 0xFFFF);
                self.builder.ins().bor_imm_u(low, i64::from(m.imm))
            }
            _ => return Err(NoNextPacket::PacketInterpreted),
        })
    }

    /// 1 or 0.
    fn test(&mut self, condition: IntCC, s1: Value, s2: Value) -> Value {
        let truth = self.builder.ins().icmp(condition, s1, s2);
        self.builder.ins().uextend(types::I32, truth)
    }

    /// 64 bits with the sign.
    pub(super) fn sign(&mut self, value: Value) -> Value {
        self.builder.ins().sextend(types::I64, value)
    }

    /// 64 bits clamped to 32.
    fn saturate(&mut self, wide: Value) -> Value {
        let least = self.builder.ins().iconst(types::I64, i64::from(i32::MIN));
        let most = self.builder.ins().iconst(types::I64, i64::from(i32::MAX));
        let wide = self.builder.ins().smax(wide, least);
        let wide = self.builder.ins().smin(wide, most);
        self.builder.ins().ireduce(types::I32, wide)
    }

    /// Number of bits above the leftmost bit of s2 that equals s1&1.
    fn leftmost(&mut self, s1: Value, s2: Value) -> Value {
        let wanted = self.builder.ins().band_imm_u(s1, 1);
        let other = self.builder.ins().bnot(s2);
        let searched = self.builder.ins().select(wanted, s2, other);
        self.builder.ins().clz(searched)
    }

    /// Two sums or differences of 16 bits.
    fn halves(&mut self, is_sum: bool, s1: Value, s2: Value) -> Value {
        let high1 = self.builder.ins().band_imm_u(s1, 0xFFFF_0000);
        let high2 = self.builder.ins().band_imm_u(s2, 0xFFFF_0000);
        let mut sum = |one, two| {
            if is_sum { self.builder.ins().iadd(one, two) } else { self.builder.ins().isub(one, two) }
        };
        let (high, low) = (sum(high1, high2), sum(s1, s2));
        let low = self.builder.ins().band_imm_u(low, 0xFFFF);
        self.builder.ins().bor(high, low)
    }

    /// Bits from `s1[9:5]` to `s1[4:0]` of s2 set or cleared.
    fn bits(&mut self, sets: bool, s1: Value, s2: Value) -> Value {
        let (low, high) = self.two_counts(s1);
        let all = self.builder.ins().iconst(types::I32, 0xFFFF_FFFF);
        let most = self.builder.ins().iconst(types::I32, 31);
        let above = self.builder.ins().isub(most, high);
        let upto = self.builder.ins().ushr(all, above);
        let from = self.builder.ins().ishl(all, low);
        let mask = self.builder.ins().band(upto, from);
        let is_empty = self.builder.ins().icmp(IntCC::UnsignedLessThan, high, low);
        let none = self.builder.ins().iconst(types::I32, 0);
        let mask = self.builder.ins().select(is_empty, none, mask);
        if sets {
            return self.builder.ins().bor(s2, mask);
        }
        let rest = self.builder.ins().bnot(mask);
        self.builder.ins().band(s2, rest)
    }

    /// A bit field.
    fn field(&mut self, is_signed: bool, s1: Value, s2: Value) -> Value {
        let (left, right) = self.two_counts(s1);
        let up = self.builder.ins().ishl(s2, left);
        if is_signed { self.builder.ins().sshr(up, right) } else { self.builder.ins().ushr(up, right) }
    }

    /// `s1[9:5]` and `s1[4:0]`.
    fn two_counts(&mut self, s1: Value) -> (Value, Value) {
        let first = self.builder.ins().ushr_imm_u(s1, 5);
        let first = self.builder.ins().band_imm_u(first, 31);
        (first, self.builder.ins().band_imm_u(s1, 31))
    }

    /// Shifts by up to 63.
    fn shift(&mut self, work: Work, s1: Value, s2: Value) -> Value {
        let wide =
            if work == Work::Shru { self.builder.ins().uextend(types::I64, s2) } else { self.sign(s2) };
        let bits = if work == Work::Sshl { 31 } else { 63 };
        let count = self.builder.ins().band_imm_u(s1, bits);
        let count = self.builder.ins().uextend(types::I64, count);
        let ins = self.builder.ins();
        let wide = match work {
            Work::Shr => ins.sshr(wide, count),
            Work::Shru => ins.ushr(wide, count),
            _ => ins.ishl(wide, count),
        };
        if work == Work::Sshl {
            return self.saturate(wide);
        }
        self.builder.ins().ireduce(types::I32, wide)
    }

    /// A product of 16 bits.
    fn product(&mut self, halves: u8, s1: Value, s2: Value) -> Value {
        let halves = Halves::from_bits(halves);
        let [one, two] =
            [(s1, halves.first()), (s2, halves.second())].map(|(source, (is_high, is_signed))| {
                let up = if is_high { source } else { self.builder.ins().ishl_imm_u(source, 16) };
                if is_signed {
                    self.builder.ins().sshr_imm_u(up, 16)
                } else {
                    self.builder.ins().ushr_imm_u(up, 16)
                }
            });
        if !halves.is_saturating() {
            return self.builder.ins().imul(one, two);
        }
        let (one, two) = (self.sign(one), self.sign(two));
        let product = self.builder.ins().imul(one, two);
        let product = self.builder.ins().ishl_imm_u(product, 1);
        self.saturate(product)
    }

    /// A source of 40-bit arithmetic, sign-extended to 64 bits.
    fn long_source(
        &mut self,
        packet_state: &PacketState,
        m: &MicroOp,
        reg: u8,
        is_pair: bool,
        imm: u32,
    ) -> Value {
        let low = self.read(packet_state, reg);
        if is_pair {
            let high = self.read(packet_state, reg | 1);
            let whole = self.join(low, high);
            let up = self.builder.ins().ishl_imm_u(whole, 64 - LONG);
            return self.builder.ins().sshr_imm_u(up, 64 - LONG);
        }
        let word = self.builder.ins().iadd_imm_s(low, signed(imm));
        if m.flags & UNSIGNED != 0 { self.builder.ins().uextend(types::I64, word) } else { self.sign(word) }
    }

    /// Returns both sources.
    fn long_sources(&mut self, packet_state: &PacketState, m: &MicroOp) -> [Value; 2] {
        let one = self.long_source(packet_state, m, m.a, m.flags & LONG1 != 0, m.imm);
        [one, self.long_source(packet_state, m, m.b, m.flags & LONG2 != 0, 0)]
    }

    fn long(&mut self, packet_state: &PacketState, m: &MicroOp, s1: Value) -> Result<Value, NoNextPacket> {
        let [one, two] = self.long_sources(packet_state, m);
        let count = self.builder.ins().band_imm_u(s1, 63);
        let count = self.builder.ins().uextend(types::I64, count);
        Ok(match m.work {
            Work::AddLong => self.builder.ins().iadd(one, two),
            Work::SubLong => self.builder.ins().isub(one, two),
            // Bits above the fortieth are cut off in the end.
            Work::ShlLong => self.builder.ins().ishl(two, count),
            Work::ShrLong => self.builder.ins().sshr(two, count),
            Work::ShruLong => {
                let up = self.builder.ins().ishl_imm_u(two, 64 - LONG);
                let plain = self.builder.ins().ushr_imm_u(up, 64 - LONG);
                self.builder.ins().ushr(plain, count)
            }
            _ => return Err(NoNextPacket::PacketInterpreted),
        })
    }

    fn compare_long(&mut self, packet_state: &PacketState, m: &MicroOp) -> Value {
        let sources = self.long_sources(packet_state, m);
        // Unsigned 40-bit values compare like the same bits shifted to the top.
        let [one, two] = sources.map(|source| self.builder.ins().ishl_imm_u(source, 64 - LONG));
        let condition = match m.work {
            Work::CmpgtLong => IntCC::SignedGreaterThan,
            Work::CmpltLong => IntCC::SignedLessThan,
            Work::CmpgtuLong => IntCC::UnsignedGreaterThan,
            Work::CmpltuLong => IntCC::UnsignedLessThan,
            _ => IntCC::Equal,
        };
        self.test(condition, one, two)
    }

    /// Writes a 40-bit result in E1.
    fn write_long(
        &mut self,
        packet_state: &mut PacketState,
        m: &MicroOp,
        value: Value,
    ) -> Result<(), NoNextPacket> {
        let (low, high) = self.split(value);
        let high = self.builder.ins().band_imm_u(high, 0xFF);
        self.write_result(packet_state, m, m.dst, low)?;
        self.write_result(packet_state, m, m.dst | 1, high)
    }

    /// Adds a double whose low word is available in the first stage, the high word in the second.
    fn give_double(
        &mut self,
        packet_state: &mut PacketState,
        m: &MicroOp,
        value: Value,
    ) -> Result<(), NoNextPacket> {
        let (low, high) = self.split(value);
        self.write_result(packet_state, m, m.dst, low)?;
        self.push(packet_state, 2, m.dst | 1, high)
    }

    /// Two words that land.
    pub(super) fn push_pair(
        &mut self,
        packet_state: &mut PacketState,
        due: [u8; 2],
        reg: u8,
        value: Value,
    ) -> Result<(), NoNextPacket> {
        let (low, high) = self.split(value);
        self.push(packet_state, due[0], reg, low)?;
        self.push(packet_state, due[1], reg | 1, high)
    }

    /// The words of 64 bits.
    pub(super) fn split(&mut self, value: Value) -> (Value, Value) {
        let low = self.builder.ins().ireduce(types::I32, value);
        let high = self.builder.ins().ushr_imm_u(value, 32);
        let high = self.builder.ins().ireduce(types::I32, high);
        self.halves.insert(low, (value, PairWord::Low));
        self.halves.insert(high, (value, PairWord::High));
        (low, high)
    }

    /// The 64-bit value of two words; if both are halves of the same value, that value.
    pub(super) fn join(&mut self, low: Value, high: Value) -> Value {
        let of = |word| self.halves.get(&self.builder.func.dfg.resolve_aliases(word));
        if let (Some((whole, PairWord::Low)), Some((other, PairWord::High))) = (of(low), of(high))
            && whole == other
        {
            return *whole;
        }
        let low = self.builder.ins().uextend(types::I64, low);
        let high = self.builder.ins().uextend(types::I64, high);
        let high = self.builder.ins().ishl_imm_u(high, 32);
        self.builder.ins().bor(high, low)
    }
}

fn signed(imm: u32) -> i64 {
    i64::from(imm.cast_signed())
}
